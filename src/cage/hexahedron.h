/// \file
/// Solids with eight corners and six quads: boxes, and boxes bent to share a face with a neighbour.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>

namespace cagewright {

/// The corners of the six faces -x, +x, -y, +y, -z, +z, counter-clockwise from outside. Corner i
/// lies on the + side of x when i & 1, of y when i & 2 and of z when i & 4 (as in make_cube).
inline constexpr std::array<std::array<Index, 4>, 6> hexahedron_faces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// The face opposite to face f.
constexpr int opposite_face(int f) {
  return f ^ 1;
}

struct Hexahedron {
  std::array<Vec3, 8> corners;

  /// Whether face f is, corner for corner, also a face of another solid: nothing may move it.
  std::array<bool, 6> shared{};

  /// Whether the solid is a box. Its corners are rounded, so four of them need not lie in a plane;
  /// with the flag set corners 0, 1, 2, 4 define the solid and the others follow exactly.
  bool is_box = false;

  /// Corner `i` (in 0..3) of face f.
  [[nodiscard]] const Vec3& corner(int f, int i) const { return corners[hexahedron_faces[f][i]]; }
};

/// The box with that center, those axes (columns, orthonormal and right-handed) and half-lengths.
Hexahedron make_box(const Vec3& center, const Mat3& axes, const Vec3& half);

/// The mean of the corners of face f.
Vec3 face_center(const Hexahedron& solid, int f);

/// The vector area of face f: along the outward normal, as long as the face is large. For a bent
/// quad the same whichever way it is cut.
Vec3 face_area(const Hexahedron& solid, int f);

/// The quads cut into twelve triangles over the corners, those of face f at 2f and 2f + 1.
///
/// A bent quad is cut along the diagonal that lies outside, so that the solid keeps the volume of
/// both cuts. A shared one, which looks bent outward to one owner and inward to the other, is cut
/// from its lexicographically least corner: both owners cut it alike.
std::array<Triangle, 12> triangulate(const Hexahedron& solid);

/// Volume of the solid so triangulated; negative when it is inside out.
double volume(const Hexahedron& solid);

/// Whether no corner lies further than `tolerance` (a length) in front of any of its triangles,
/// and none of these is degenerate.
bool is_convex(const Hexahedron& solid, double tolerance);

/// How far the point lies in front of the triangle's plane that it is furthest in front of: of a
/// convex solid, the signed distance to its nearest face for points inside (negative).
double height_above(const Hexahedron& solid, const Vec3& point);

} // namespace cagewright
