/// \file
/// The similarity that fits a pose of a cage best. Internal to this module.
#pragma once

#include <cagewright/core/geometry.h>

#include <span>

namespace cagewright {

/// p -> scale * turn * p + shift, without reflection.
struct Similarity {
  Mat3 turn = Mat3::Identity();
  double scale = 1;
  Vec3 shift = Vec3::Zero();

  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return scale * (turn * p) + shift; }
};

/// The one with the least sum of squared distances from rest to pose (Umeyama 1991); the identity,
/// exactly, where nothing has moved.
Similarity best_similarity(std::span<const Vec3> rest, std::span<const Vec3> pose);

/// The rotation nearest to a matrix, the factor of its polar decomposition; `otherwise` where it is
/// singular.
Mat3 nearest_rotation(const Mat3& m, const Mat3& otherwise);

} // namespace cagewright
