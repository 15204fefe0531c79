/// \file
/// Geometric questions answered without error: every answer is that of exact arithmetic on the
/// coordinates as doubles, for finite coordinates below 1e100 in magnitude.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cmath>
#include <span>

namespace cagewright {

namespace exact_detail {
int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy);
} // namespace exact_detail

/// Sign of det[b - a, c - a, d - a]: 1 when d lies on the side of the plane a b c that its normal
/// (b - a) x (c - a) points to, -1 on the other, 0 when the four are coplanar.
///
/// Cost: a few nanoseconds unless the points are nearly coplanar (Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic", 1997: his first filter, then exact expansions).
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ax = a.x() - d.x();
  const double ay = a.y() - d.y();
  const double az = a.z() - d.z();
  const double bx = b.x() - d.x();
  const double by = b.y() - d.y();
  const double bz = b.z() - d.z();
  const double cx = c.x() - d.x();
  const double cy = c.y() - d.y();
  const double cz = c.z() - d.z();
  const double bxcy = bx * cy;
  const double cxby = cx * by;
  const double cxay = cx * ay;
  const double axcy = ax * cy;
  const double axby = ax * by;
  const double bxay = bx * ay;
  // Seen from d the determinant of the three differences has the other sign.
  const double det = az * (cxby - bxcy) + bz * (axcy - cxay) + cz * (bxay - axby);
  const double permanent = (std::abs(bxcy) + std::abs(cxby)) * std::abs(az) +
                           (std::abs(cxay) + std::abs(axcy)) * std::abs(bz) +
                           (std::abs(axby) + std::abs(bxay)) * std::abs(cz);
  // The constant covers what underflow may have cost.
  const double bound = 7.8e-16 * permanent + 1e-150;
  if (det > bound) {
    return 1;
  }
  if (det < -bound) {
    return -1;
  }
  return exact_detail::orient3d_exact(a, b, c, d);
}

/// Sign of the area of a b c after dropping the coordinate `axis` (0, 1 or 2): 1 when the turn is
/// counter-clockwise in the remaining two, taken in the cyclic order x y z.
inline int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  const int u = axis == 2 ? 0 : axis + 1;
  const int v = axis == 0 ? 2 : axis - 1;
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  const double det = left - right;
  const double bound = 3.4e-16 * (std::abs(left) + std::abs(right)) + 1e-200;
  if (det > bound) {
    return 1;
  }
  if (det < -bound) {
    return -1;
  }
  return exact_detail::orient2d_exact(a[u], a[v], b[u], b[v], c[u], c[v]);
}

/// True when a, b, c lie on one line (or in one point).
inline bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  return orient2d(a, b, c, 0) == 0 && orient2d(a, b, c, 1) == 0 && orient2d(a, b, c, 2) == 0;
}

/// True when the closed segments p q and r s have a point in common. A segment may be a point.
bool segments_intersect(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s);

/// True when the closed segment p q and the closed triangle a b c have a point in common. Touching
/// counts; the segment may be a point, the triangle a segment or a point.
bool segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                 const Vec3& c);

/// True when the two closed triangles have a point in common. Touching counts; a degenerate
/// triangle is the segment or the point that its corners span.
bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]);

/// True when an edge of one triangle passes through the inside of the other: from one side of its
/// plane to the other, past no edge or corner. Touching and overlapping in a plane do not count.
bool triangles_cross_properly(const Vec3 (&a)[3], const Vec3 (&b)[3]);

/// True when two faces of one mesh have a point in common that is not part of the corner or edge
/// that they share by index. Faces with the same three corners cross. Of two faces that share
/// corners neither should be degenerate: the answer may then be true where they only touch.
bool faces_cross(std::span<const Vec3> positions, const Triangle& a, const Triangle& b);

/// Sign of the volume that a closed, consistently oriented mesh encloses: 1 when it is oriented
/// outward, -1 when inward, 0 when it encloses nothing. Of an open mesh the sign means nothing.
int volume_sign(TriangleView mesh);

} // namespace cagewright
