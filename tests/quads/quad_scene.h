/// \file
/// A model and a valid cage of triangles and quads round it, for the tests of the steps to quads.
#pragma once

#include "improve/objective.h"
#include "mesh/shapes.h"
#include "quads/pairing.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace cagewright::test {

inline TriangleMesh scaled(TriangleMesh mesh, double scale) {
  for (Vec3& p : mesh.positions) {
    p *= scale;
  }
  return mesh;
}

/// A sphere in another, with room between them, and some of the triangles of the outer one paired.
struct QuadScene {
  QuadScene()
      : model(scaled(make_icosphere(3), 0.6)), surface(model),
        guard(surface, 0.005 * surface.diagonal, {}), objective(surface, weights()),
        triangles(bumpy(make_icosphere(2))), field(triangles), cage(triangles) {
    pair_triangles(cage, guard, field, {});
    cage.renumber_faces();
  }

  static ObjectiveWeights weights() {
    ObjectiveWeights result;
    result.typical_area = 0.1;
    return result;
  }
  static TriangleMesh bumpy(TriangleMesh mesh) {
    for (Vec3& p : mesh.positions) {
      p *= 1 + 0.05 * std::sin(7 * p.x()) * std::cos(5 * p.z());
    }
    return mesh;
  }

  /// Quads cut along their first diagonals, and along their second.
  [[nodiscard]] TriangleMesh cut(bool second) const {
    TriangleMesh mesh{cage.positions(), {}};
    for (Index f = 0; f < cage.face_end(); ++f) {
      const CageFace& face = cage.face(f);
      if (face.size == 3) {
        mesh.triangles.push_back({face[0], face[1], face[2]});
      } else if (face.is_quad()) {
        const int k = second && !face.tentative ? 1 : 0;
        mesh.triangles.push_back({face[k], face[k + 1], face[k + 2]});
        mesh.triangles.push_back({face[k], face[k + 2], face[k + 3]});
      }
    }
    return mesh;
  }
  /// Valid along either diagonal, and clear of the model.
  void expect_sound() const {
    for (const bool second : {false, true}) {
      EXPECT_TRUE(validate_cage(cut(second), model)->valid());
    }
    for (Index f = 0; f < cage.face_end(); ++f) {
      EXPECT_TRUE(!cage.has_face(f) || guard.is_clear(cage.positions(), cage.face(f)));
    }
  }
  [[nodiscard]] std::size_t count(int size) const {
    std::size_t result = 0;
    for (Index f = 0; f < cage.face_end(); ++f) {
      result += cage.face(f).size == size ? 1 : 0;
    }
    return result;
  }

  TriangleMesh model;
  ModelSurface surface;
  QuadGuard guard;
  Objective objective;
  TriangleMesh triangles;
  DirectionField field;
  QuadCage cage;
};

} // namespace cagewright::test
