/// \file
/// Geometry and failures as JSON, the same in every command.
#pragma once

#include "obb/oriented_box.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <string_view>

namespace cagewright::cli {

/// [x, y, z]
nlohmann::json json_of(const Vec3& v);

/// An object with center, axes (three unit vectors), half_lengths and volume.
nlohmann::json json_of(const OrientedBox& box);

/// What went wrong: code, message, and as far as the message tells them file, place (line or byte)
/// and remedy, else null.
///
/// \param code   as it stands in JSON
/// \param words  the command line: the file is the one among them that the message begins with
nlohmann::json json_of_failure(std::string_view code, const std::string& message,
                               std::span<const std::string> words);

/// The text that stands in a file. Bytes that are not UTF-8, as in the names of some files, become
/// U+FFFD.
std::string text_of(const nlohmann::json& json, int indent);

/// Writes the file of --json; "-" is the standard output. Errors: cannot_write.
Status write_json(const std::string& path, const nlohmann::json& json, int indent = 1);

} // namespace cagewright::cli
