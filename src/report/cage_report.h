/// \file
/// What `generate` says about its work: a summary for people, JSON for programs.
#pragma once

#include "cage/decompose.h"
#include <cagewright/cage/generate.h>

#include <nlohmann/json.hpp>

#include <string>

namespace cagewright {

/// Boxes, cuts, f(x) of every box and axis, in the model's own units.
nlohmann::json to_json(const BoxDecomposition& boxes, const std::vector<int>& cover);

/// The options, the start, the cage and how it came about; with boxes, all of them too.
nlohmann::json to_json(const GeneratedCage& made, const GenerateOptions& options);

std::string summary(const BoxDecomposition& boxes, const std::vector<int>& cover);
std::string summary(const GeneratedCage& made, const GenerateOptions& options);

} // namespace cagewright
