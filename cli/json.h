/// \file
/// Failures as JSON, and JSON in files, the same in every command.
#pragma once

#include "report/json.h"
#include <cagewright/core/result.h>

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <string_view>

namespace cagewright::cli {

/// What went wrong: code, message, and as far as the message tells them file, place (line or byte)
/// and remedy, else null.
///
/// \param code   as it stands in JSON
/// \param words  the command line: the file is the one among them that the message begins with
nlohmann::json json_of_failure(std::string_view code, const std::string& message,
                               std::span<const std::string> words);

/// Writes the file of --json; "-" is the standard output. Errors: cannot_write.
Status write_json(const std::string& path, const nlohmann::json& json, int indent = 1);

} // namespace cagewright::cli
