/// \file
/// The kinds of coordinates for programs to read.
#pragma once

#include <nlohmann/json.hpp>

namespace cagewright {

/// What `cagewright coordinates --json` writes: for each kind its name, what it is, reproduces and
/// costs, and its options with their words or ranges.
nlohmann::json coordinate_kinds_as_json();

} // namespace cagewright
