/// \file
/// All vertices of a quad cage moved at once, its faces left as they are.
#pragma once

#include "improve/objective.h"
#include "quads/quad_guard.h"
#include <cagewright/core/progress.h>

#include <limits>

namespace cagewright {

struct RelaxQuadsOptions {
  int steps = 8;
  double first_step = 0.02;  ///< no vertex moves further in the first step, in diagonals
  double least_gain = 0.002; ///< stop when a step lowers the objective by less than this share
  /// The distance from the model that the steps aim at, in diagonals: at least the guard's
  /// clearance. More than that makes room.
  double keep = 0;
  /// By what share of itself a step may raise the objective where it makes room.
  double most_rise = std::numeric_limits<double>::infinity();
  // What quads should look like, in weights of the shape of triangles; l^2 is the mean of the
  // squared diagonals.
  double even = 2;        ///< |a - b + c - d|^2 / l^2 of the corners: 0 for a parallelogram
  double square = 1;      ///< the squared difference of the squared diagonals, over l^4
  double corner = 100;    ///< for each corner, the square of what its sine is below `free_sine`
  double free_sine = 0.5; ///< that of 30 degrees and of 150
  double flat = 800;      ///< the square of what the warp (six volumes / l^3) is above `free_warp`
  double free_warp = 0.1; ///< that of a square bent by 24 degrees
  double slender = 0; ///< of each cutting's triangles, the square of their shape_defect() above ...
  double free_defect = 3; ///< ... this: that of a rectangle seven times as long as wide
  double tentative = 3;   ///< how many times as much all these count for tentative quads
};

/// Lowers the engine's objective, taken over both cuttings of every quad, along with terms for
/// square corners, planarity and parallel sides, by sequential quadratic programs like relax(). The
/// guard's limits of bend and of flat corners are half spaces in them, like the clearance: quads
/// beyond the limits are brought nearer to them. The cage stays valid throughout, under every
/// choice of diagonals. Vertices of a half cage's border move in the plane x = 0.
///
/// \returns the objective of the result
double relax_quads(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress = {});

} // namespace cagewright
