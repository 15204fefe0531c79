/// \file
/// Points and rotations for the tests of boxes.
#pragma once

#include "core/random.h"
#include <cagewright/core/geometry.h>

#include <cstdint>
#include <numbers>
#include <vector>

namespace cagewright::test {

/// Some rotation, another for each seed.
inline Mat3 rotation(std::uint64_t seed) {
  Random random(seed);
  const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1));
  return Eigen::AngleAxisd(random.uniform(0.1, std::numbers::pi), axis.normalized())
      .toRotationMatrix();
}

/// Points uniform in the box [-half, half].
inline std::vector<Vec3> points_in_box(const Vec3& half, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-half.x(), half.x());
    const double y = random.uniform(-half.y(), half.y());
    points.emplace_back(x, y, random.uniform(-half.z(), half.z()));
  }
  return points;
}

/// The points turned, scaled and moved.
inline std::vector<Vec3> moved(const std::vector<Vec3>& points, const Mat3& turn, double scale,
                               const Vec3& shift) {
  std::vector<Vec3> result;
  for (const Vec3& p : points) {
    result.push_back(scale * (turn * p) + shift);
  }
  return result;
}

} // namespace cagewright::test
