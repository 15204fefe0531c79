/// \file
/// Simple bodies with limbs, to be joined from ellipsoids.
#pragma once

#include "mesh/shapes.h"

namespace cagewright::test {

/// \param half  the lengths of its half axes
inline TriangleMesh ellipsoid(const Vec3& center, const Vec3& half, int subdivisions = 2) {
  TriangleMesh mesh = make_icosphere(subdivisions);
  for (Vec3& p : mesh.positions) {
    p = center + p.cwiseProduct(half);
  }
  return mesh;
}

} // namespace cagewright::test
