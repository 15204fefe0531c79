/// \file
/// Distances between points, segments and triangles, in double precision.
#pragma once

#include <cagewright/core/geometry.h>

namespace cagewright {

/// The point of the segment a b nearest to p. The segment may be a point.
Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// The point of the triangle a b c nearest to p. The triangle may be a segment or a point.
/// (Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.)
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// |p - nearest_on_triangle(p, a, b, c)|
double point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Two points, one of each of two shapes, and how far apart they are.
struct ClosestPoints {
  double distance = 0;
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
};

/// The nearest points of the segments p q and r s.
ClosestPoints segment_segment_closest(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s);

/// The nearest points of two triangles; distance 0 where they cross.
ClosestPoints triangle_triangle_closest(const Vec3 (&a)[3], const Vec3 (&b)[3]);

/// triangle_triangle_closest(a, b).distance
double triangle_triangle_distance(const Vec3 (&a)[3], const Vec3 (&b)[3]);

} // namespace cagewright
