/// \file
/// Deforming without keeping weights: any number of vertices, in double, in no memory.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

struct StreamedPoses {
  std::vector<std::vector<Vec3>> positions; ///< for each pose P positions
  PointCounts counts;                       ///< those that are undefined stay where they are
};

/// Moves points as the cage moves from its rest to each of several poses. Weights are computed
/// once, sixteen points at a time, applied to all poses and forgotten.
///
/// \param poses  for each pose C positions
/// Errors: those of solve_all().
/// Cost: that of solve_all(), and the memory of the results.
Result<StreamedPoses> deform_streaming(const Coordinates& coordinates,
                                       std::span<const std::vector<Vec3>> poses,
                                       std::span<const Vec3> points, const Progress& progress = {});

} // namespace cagewright
