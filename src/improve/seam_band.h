/// \file
/// Where a ring round a limb stays.
#pragma once

#include <cagewright/core/geometry.h>

#include <algorithm>

namespace cagewright {

/// The space between two parallel planes.
struct SeamBand {
  Vec3 point = Vec3::Zero(); ///< amid it
  Vec3 normal = Vec3::UnitX();
  double half_width = 0;

  /// How far p is from its middle, along the normal.
  [[nodiscard]] double height(const Vec3& p) const { return normal.dot(p - point); }

  /// The point of the band nearest to p.
  [[nodiscard]] Vec3 nearest(const Vec3& p) const {
    const double h = height(p);
    return p + (std::clamp(h, -half_width, half_width) - h) * normal;
  }
};

} // namespace cagewright
