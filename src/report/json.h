/// \file
/// Geometry as JSON, the same everywhere.
#pragma once

#include "obb/oriented_box.h"
#include <cagewright/core/geometry.h>

#include <nlohmann/json.hpp>

#include <string>

namespace cagewright {

/// [x, y, z]
nlohmann::json json_of(const Vec3& v);

/// An object with center, axes (three unit vectors), half_lengths and volume.
nlohmann::json json_of(const OrientedBox& box);

/// The text that stands in a file. Bytes that are not UTF-8, as in the names of some files, become
/// U+FFFD.
std::string text_of(const nlohmann::json& json, int indent);

} // namespace cagewright
