/// \file
/// Points where coordinates go wrong: near, on and beside the elements of a cage.
#pragma once

#include "core/random.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <cmath>
#include <string>
#include <vector>

namespace cagewright::test {

/// What a point is placed relative to.
enum class Site {
  face,      ///< above the inside of a face
  edge,      ///< in any direction from an edge
  vertex,    ///< in any direction from a vertex
  plane,     ///< above the plane of a face, outside the face
  line,      ///< in any direction from the line through an edge, beyond its ends
  beside,    ///< just across an edge from a face, nearly in its plane
  at_corner, ///< just across a vertex from a face, nearly in its plane
};

inline std::string name_of(Site site) {
  switch (site) {
  case Site::face:
    return "Face";
  case Site::edge:
    return "Edge";
  case Site::vertex:
    return "Vertex";
  case Site::plane:
    return "Plane";
  case Site::line:
    return "Line";
  case Site::beside:
    return "Beside";
  case Site::at_corner:
    return "AtCorner";
  }
  return "";
}

inline Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1) {
      return v.normalized();
    }
  }
}

/// A random point at `distance` from a random element of the cage, on either side.
inline Vec3 point_near(TriangleView cage, Site site, double distance, Random& random) {
  const Triangle& t = cage.triangles[random.below(cage.triangles.size())];
  const Vec3 a = cage.positions[t[0]];
  const Vec3 ab = cage.positions[t[1]] - a;
  const Vec3 ac = cage.positions[t[2]] - a;
  const Vec3 up = ab.cross(ac).normalized() * (random.below(2) == 0 ? distance : -distance);
  const Vec3 away = random_direction(random) * distance;
  double u = random.uniform();
  double v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const double step = std::pow(10.0, random.uniform(-12, 0));
  switch (site) {
  case Site::face:
    return a + u * ab + v * ac + up;
  case Site::edge:
    return a + u * ab + away;
  case Site::vertex:
    return a + away;
  case Site::plane:
    return a - (u + 0.01) * ab + 2 * v * ac + up;
  case Site::line:
    return a - (u + 0.01) * ab + away;
  case Site::beside:
    return a + u * ab - step * ac + step * up;
  case Site::at_corner:
    return a - step * u * ab - step * v * ac + step * up;
  }
  return a;
}

} // namespace cagewright::test
