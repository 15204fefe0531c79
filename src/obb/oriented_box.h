/// \file
/// A box at any angle.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <span>

namespace cagewright {

/// Three orthonormal right-handed axes (columns), and the half-lengths along them. The default is
/// the origin alone.
struct OrientedBox {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  Vec3 half = Vec3::Zero();

  [[nodiscard]] double volume() const { return 8 * half.prod(); }

  /// Corner i lies on the positive side of axis 0 when i & 1, of axis 1 when i & 2 and of axis 2
  /// when i & 4, as the vertices of make_cube().
  [[nodiscard]] std::array<Vec3, 8> corners() const;

  /// p in the box's own coordinates: the box is [-half, half].
  [[nodiscard]] Vec3 to_local(const Vec3& p) const { return axes.transpose() * (p - center); }

  /// Whether p lies in the closed box grown by `tolerance` (a length) on every side.
  [[nodiscard]] bool contains(const Vec3& p, double tolerance = 0) const;

  /// The box grown by the length `by` on every side.
  [[nodiscard]] OrientedBox padded(double by) const;
};

/// The box as a closed surface: its 8 corners() and 12 outward triangles.
TriangleMesh to_mesh(const OrientedBox& box);

/// The tight box of the points among those with these orthonormal axes. For no points, a box at the
/// origin without extent.
OrientedBox box_in_frame(const Mat3& axes, std::span<const Vec3> points);

/// The same box with its axes reordered, the longest first, and right-handed. Axes of equal length
/// keep their order.
OrientedBox sorted_by_length(const OrientedBox& box);

} // namespace cagewright
