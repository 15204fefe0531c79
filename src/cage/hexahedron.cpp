#include "cage/hexahedron.h"

#include <algorithm>
#include <limits>

namespace cagewright {
namespace {

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Whether face f is cut from its corner 0 to its corner 2, and not from 1 to 3.
bool cut_from_first_corner(const Hexahedron& solid, int f) {
  if (solid.shared[f]) {
    int least = 0;
    for (int i = 1; i < 4; ++i) {
      if (lexicographically_less(solid.corner(f, i), solid.corner(f, least))) {
        least = i;
      }
    }
    return least % 2 == 0;
  }
  const Vec3& a = solid.corner(f, 0);
  const Vec3 normal = (solid.corner(f, 1) - a).cross(solid.corner(f, 2) - a);
  return normal.dot(solid.corner(f, 3) - a) <= 0; // corner 3 is behind: the edge 0-2 is a ridge
}

Vec3 normal_of(const Hexahedron& solid, const Triangle& t) {
  const Vec3& a = solid.corners[t[0]];
  return (solid.corners[t[1]] - a).cross(solid.corners[t[2]] - a).normalized();
}

} // namespace

Hexahedron make_box(const Vec3& center, const Mat3& axes, const Vec3& half) {
  Hexahedron box;
  box.is_box = true;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 sign((i & 1U) ? 1 : -1, (i & 2U) ? 1 : -1, (i & 4U) ? 1 : -1);
    box.corners[i] = center + axes * half.cwiseProduct(sign);
  }
  return box;
}

Vec3 face_center(const Hexahedron& solid, int f) {
  return (solid.corner(f, 0) + solid.corner(f, 1) + solid.corner(f, 2) + solid.corner(f, 3)) / 4;
}

Vec3 face_area(const Hexahedron& solid, int f) {
  const Vec3 diagonal = solid.corner(f, 2) - solid.corner(f, 0);
  return diagonal.cross(solid.corner(f, 3) - solid.corner(f, 1)) / 2;
}

std::array<Triangle, 12> triangulate(const Hexahedron& solid) {
  std::array<Triangle, 12> triangles;
  for (int f = 0; f < 6; ++f) {
    const auto& [a, b, c, d] = hexahedron_faces[f];
    const bool first = cut_from_first_corner(solid, f);
    triangles[2 * f] = first ? Triangle{a, b, c} : Triangle{a, b, d};
    triangles[2 * f + 1] = first ? Triangle{a, c, d} : Triangle{b, c, d};
  }
  return triangles;
}

double volume(const Hexahedron& solid) {
  const Vec3& origin = solid.corners[0]; // near the solid, so that little cancels
  double six_volumes = 0;
  for (const Triangle& t : triangulate(solid)) {
    six_volumes += (solid.corners[t[0]] - origin)
                       .dot((solid.corners[t[1]] - origin).cross(solid.corners[t[2]] - origin));
  }
  return six_volumes / 6;
}

double height_above(const Hexahedron& solid, const Vec3& point) {
  double height = -std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangulate(solid)) {
    height = std::max(height, normal_of(solid, t).dot(point - solid.corners[t[0]]));
  }
  return height;
}

bool is_convex(const Hexahedron& solid, double tolerance) {
  for (const Triangle& t : triangulate(solid)) {
    const Vec3 normal = normal_of(solid, t);
    if (!(normal.squaredNorm() > 0.5)) {
      return false;
    }
    for (const Vec3& corner : solid.corners) {
      if (!(normal.dot(corner - solid.corners[t[0]]) <= tolerance)) {
        return false;
      }
    }
  }
  return true;
}

} // namespace cagewright
