/// \file
/// Meshes made worse, moved and measured, for the tests of voxels.
#pragma once

#include "core/random.h"
#include "mesh/shapes.h"
#include "voxel/voxel_grid.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace cagewright::test {

inline Mat3 rotation(std::uint64_t seed) {
  Random random(seed);
  const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1));
  return Eigen::AngleAxisd(random.uniform(0.1, std::numbers::pi), axis.normalized())
      .toRotationMatrix();
}

inline TriangleMesh moved(TriangleMesh mesh, const Mat3& turn, double scale, const Vec3& shift) {
  for (Vec3& p : mesh.positions) {
    p = scale * (turn * p) + shift;
  }
  return mesh;
}

inline TriangleMesh inverted(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) {
    std::swap(t[1], t[2]);
  }
  return mesh;
}

/// Each face removed with this probability.
inline TriangleMesh with_holes(const TriangleMesh& mesh, double share, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh result{mesh.positions, {}};
  for (const Triangle& t : mesh.triangles) {
    if (random.uniform() >= share) {
      result.triangles.push_back(t);
    }
  }
  return result;
}

/// Each face turned over with this probability.
inline TriangleMesh with_flips(TriangleMesh mesh, double share, std::uint64_t seed) {
  Random random(seed);
  for (Triangle& t : mesh.triangles) {
    if (random.uniform() < share) {
      std::swap(t[1], t[2]);
    }
  }
  return mesh;
}

/// Three corners of its own for every triangle, as in an STL file.
inline TriangleMesh as_soup(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<Index>(soup.positions.size());
    for (const Index v : t) {
      soup.positions.push_back(mesh.positions[v]);
    }
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

/// How often a mesh winds round a point: the sum of the solid angles over 4 pi.
inline double winding_number(TriangleView mesh, const Vec3& q) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]] - q;
    const Vec3 b = mesh.positions[t[1]] - q;
    const Vec3 c = mesh.positions[t[2]] - q;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

} // namespace cagewright::test
