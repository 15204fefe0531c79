/// \file
/// Deforming without keeping weights: any number of vertices, in double, in no memory.
#pragma once

#include <cagewright/coordinates/mean_value.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

struct StreamedPoses {
  std::vector<std::vector<Vec3>> positions; ///< for each pose P positions
  std::size_t on_surface = 0;               ///< points that lie on the cage at rest
  std::size_t undefined = 0;                ///< points without weights: they stay where they are
};

/// Moves points as the cage moves from its rest to each of several poses. Weights are computed
/// once, sixteen points at a time, applied to all poses and forgotten.
///
/// \param rest   C positions, those the solver was made of
/// \param poses  for each pose C positions
/// Errors: cancelled.
/// Cost: that of mean_value_coordinates(), and the memory of the results.
Result<StreamedPoses> deform_streaming(const MeanValueSolver& solver, std::span<const Vec3> rest,
                                       std::span<const std::vector<Vec3>> poses,
                                       std::span<const Vec3> points, const Progress& progress = {});

} // namespace cagewright
