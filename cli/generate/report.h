/// \file
/// What `generate` says about its work: a summary for people, JSON for programs.
#pragma once

#include "cage/box_cage.h"
#include "cage/budget_cage.h"
#include <cagewright/validate/cage_metrics.h>

#include <nlohmann/json.hpp>

#include <string>

namespace cagewright::cli {

/// Boxes, cuts, f(x) of every box and axis, in the model's own units.
nlohmann::json to_json(const BoxDecomposition& boxes, const std::vector<int>& cover);

/// The same, and the cage: its figures, the registration, the times.
nlohmann::json to_json(const BoxCage& made, const CageMetrics& metrics);

/// The budget, the start and the cage.
nlohmann::json to_json(const BudgetCage& made, const CageMetrics& metrics);

std::string summary(const BoxDecomposition& boxes, const std::vector<int>& cover);
std::string summary(const BoxCage& made, const CageMetrics& metrics);
std::string summary(const BudgetCage& made, const CageMetrics& metrics);

} // namespace cagewright::cli
