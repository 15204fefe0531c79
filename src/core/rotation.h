/// \file
/// Rotations that have the same bits everywhere.
#pragma once

#include "core/maths.h"

#include <cagewright/core/geometry.h>

namespace cagewright {

/// The rotation by an angle (radians, |angle| <= 1e5) about an axis of length 1: Rodrigues'
/// formula.
inline Mat3 rotation_about(const Vec3& axis, double angle) {
  const double c = maths::cos(angle);
  const Vec3 s = maths::sin(angle) * axis;
  Mat3 across;
  across << 0, -s.z(), s.y(), s.z(), 0, -s.x(), -s.y(), s.x(), 0;
  return c * Mat3::Identity() + across + (1 - c) * axis * axis.transpose();
}

} // namespace cagewright
