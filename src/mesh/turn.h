/// \file
/// Which way three points turn in the plane, without error.
#pragma once

#include <cagewright/core/geometry.h>

namespace cagewright {

/// A projection onto the two coordinates that a polygon's plane leaves largest: drops `axis`, and
/// looks from the side from which the polygon runs counter-clockwise.
struct PlaneView {
  int axis = 2;
  bool flipped = false;

  /// The view of a polygon with that normal of any length.
  static PlaneView of(const Vec3& normal) {
    Eigen::Index axis = 2;
    normal.cwiseAbs().maxCoeff(&axis);
    return {static_cast<int>(axis), normal[axis] < 0};
  }
};

/// The sign of the turn from a over b to c: 1 to the left, -1 to the right, 0 for points on a line.
/// Exact for finite coordinates. (The predicates of `exact` stand above this module.)
int turn(const Vec3& a, const Vec3& b, const Vec3& c, const PlaneView& view);

} // namespace cagewright
