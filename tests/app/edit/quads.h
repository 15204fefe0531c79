/// \file
/// Cages of quads to edit in tests.
#pragma once

#include "mesh/topology.h"
#include <cagewright/mesh/polygon_mesh.h>

#include <cmath>
#include <numbers>

namespace cagewright::app::test {

/// [-1, 1]^3 with n by n quads on each side, closed and oriented outward.
inline PolygonMesh quad_cube(int n = 1) {
  PolygonMesh mesh;
  std::vector<std::array<int, 3>> keys;
  const auto vertex = [&](const std::array<int, 3>& at) {
    for (Index v = 0; v < keys.size(); ++v) {
      if (keys[v] == at) {
        return v;
      }
    }
    keys.push_back(at);
    mesh.positions.emplace_back(2.0 * at[0] / n - 1, 2.0 * at[1] / n - 1, 2.0 * at[2] / n - 1);
    return static_cast<Index>(keys.size() - 1);
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return vertex(at);
          };
          if (side == n) {
            mesh.add_face({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
          } else {
            mesh.add_face({corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)});
          }
        }
      }
    }
  }
  return mesh;
}

/// A torus of quads about the z axis.
inline PolygonMesh quad_torus(Index around = 12, Index across = 6) {
  PolygonMesh mesh;
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around;
      const double b = 2 * std::numbers::pi * j / across;
      const double r = 1 + 0.4 * std::cos(b);
      mesh.positions.emplace_back(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b));
    }
  }
  const auto at = [&](Index i, Index j) { return (i % around) * across + j % across; };
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < across; ++j) {
      mesh.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

inline bool is_sound(const PolygonMesh& mesh) {
  const TopologyReport t = topology(mesh);
  return t.is_closed() && t.is_manifold() && t.is_oriented() && t.unused_vertices.empty() &&
         t.repeated_corner_faces.empty() && t.duplicate_faces.empty();
}

} // namespace cagewright::app::test
