/// \file
/// Sizes of meshes.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <span>

namespace cagewright {

/// The axis-aligned box of the points; empty for none.
Box3 bounding_box(std::span<const Vec3> points);

/// Length of the diagonal of the axis-aligned box: the unit of all tolerances. 0 for no points.
double diagonal(std::span<const Vec3> points);

/// The box of the vertices that some triangle uses: strays do not count.
Box3 bounding_box(TriangleView mesh);

/// Sum of the triangles' areas.
double surface_area(TriangleView mesh);

/// Signed volume by the divergence theorem: positive for a closed mesh oriented outward. For an
/// open mesh it depends on the origin, which is taken at the middle of the bounding box.
double signed_volume(TriangleView mesh);

/// The same about a point: that of half a closed mesh, if the point is on the plane of the cut.
double signed_volume(TriangleView mesh, const Vec3& origin);

/// Unit normal of a triangle, or zero when it has no area.
Vec3 triangle_normal(TriangleView mesh, const Triangle& triangle);

/// 2 r / R of a triangle: 1 for an equilateral one, 0 for a degenerate one (r, R: radii of the
/// inscribed and the circumscribed circle).
double triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace cagewright
