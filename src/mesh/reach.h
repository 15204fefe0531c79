/// \file
/// How far from the origin a point may be.
#pragma once

#include <cagewright/core/geometry.h>

namespace cagewright {

/// Beyond it volumes, which have three coordinates as factors, are no finite numbers any more.
inline constexpr double largest_coordinate = 1e100;

/// Whether a point can be reckoned with: its coordinates are finite, and none of them is larger
/// than `largest_coordinate`.
inline bool is_within_reach(const Vec3& p) {
  return p.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= largest_coordinate;
}

} // namespace cagewright
