/// \file
/// All vertices of a cage moved at once, its faces left as they are.
#pragma once

#include "improve/simplify.h"
#include <cagewright/core/progress.h>

#include <span>

namespace cagewright {

struct RelaxOptions {
  int steps = 8;
  double first_step = 0.01;  ///< no vertex moves further in the first step, in diagonals; less if
                             ///< the last step on this cage was much shorter
  double least_gain = 0.002; ///< stop when a step lowers the objective by less than this share
  std::span<const Index> movable = {}; ///< only these vertices move; none: all do
};

/// Lowers the objective by sequential quadratic programs over all vertices: each step takes the
/// objective to second order and, as half spaces, the points of the model nearest to the faces
/// (linear in the three corners of a face, so that it can tilt and slide). What of a step would
/// leave the cage invalid is shortened until it does not. The cage stays valid throughout.
///
/// \returns the objective of the result: of the faces at movable vertices
double relax(WorkingCage& cage, const Guard& guard, const Objective& objective,
             const RelaxOptions& options, const Progress& progress = {});

} // namespace cagewright
