/// \file
/// Options for cages of quads that are made quickly.
#pragma once

#include "cage/budget_cage.h"

namespace cagewright::test {

/// At most so many vertices (0: no limit), not refined.
inline BudgetCageOptions quads_of(int vertices) {
  BudgetCageOptions options;
  options.improve.vertices = vertices;
  options.improve.rounds = 0;
  options.quads = true;
  return options;
}

} // namespace cagewright::test
