/// \file
/// How much of the view from a point a triangle takes.
#pragma once

#include "core/maths.h"
#include <cagewright/core/geometry.h>

namespace cagewright {

/// The solid angle of a triangle from p, positive if p sees its back: over a closed surface that is
/// oriented outward they sum to 4 pi inside, and to 0 outside. 2 pi on the triangle itself.
///
/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions on
/// Biomedical Engineering 30, 1983.
inline double solid_angle(const Vec3& p, const Vec3& corner_a, const Vec3& corner_b,
                          const Vec3& corner_c) {
  const Vec3 a = corner_a - p;
  const Vec3 b = corner_b - p;
  const Vec3 c = corner_c - p;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2 * maths::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

} // namespace cagewright
