/// \file
/// The figures of a cage, for people and for programs.
#pragma once

#include <cagewright/validate/cage_metrics.h>

#include <nlohmann/json.hpp>

#include <string>

namespace cagewright {

/// An object with the names of CageMetrics as keys.
nlohmann::json figures_as_json(const CageMetrics& metrics);

/// A few lines, indented by two spaces; distances in % of the model's diagonal.
std::string figures_as_text(const CageMetrics& metrics);

} // namespace cagewright
