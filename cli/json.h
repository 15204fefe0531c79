/// \file
/// Geometry as JSON, the same in every command.
#pragma once

#include "obb/oriented_box.h"
#include <cagewright/core/geometry.h>

#include <nlohmann/json.hpp>

namespace cagewright::cli {

/// [x, y, z]
nlohmann::json json_of(const Vec3& v);

/// An object with center, axes (three unit vectors), half_lengths and volume.
nlohmann::json json_of(const OrientedBox& box);

} // namespace cagewright::cli
