/// \file
/// All vertices of a quad cage moved at once, its faces left as they are.
#pragma once

#include "core/progress.h"
#include "improve/objective.h"
#include "quads/quad_guard.h"

namespace cagewright {

struct RelaxQuadsOptions {
  int steps = 8;
  double first_step = 0.02;  ///< no vertex moves further in the first step, in diagonals
  double least_gain = 0.002; ///< stop when a step lowers the objective by less than this share
  /// The distance from the model that the steps aim at, in diagonals: at least the guard's
  /// clearance. More than that makes room.
  double keep = 0;
  double square = 4;     ///< weight of square corners, in that of the shape of triangles
  double flat = 20;      ///< weight of planarity, the same way
  double even = 2;       ///< weight of opposite sides that are alike, the same way
  double tentative = 10; ///< the same of tentative quads
};

/// Lowers the engine's objective, taken over both cuttings of every quad, along with terms for
/// square corners, planarity and parallel sides, by sequential quadratic programs like relax(). The
/// cage stays valid throughout, under every choice of diagonals. Vertices of a half cage's border
/// move in the plane x = 0.
///
/// \returns the objective of the result
double relax_quads(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress = {});

} // namespace cagewright
