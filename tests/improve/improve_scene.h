/// \file
/// A model and a valid cage round it, for the tests of the steps of the improvement.
#pragma once

#include "improve/objective.h"
#include "improve/simplify.h"
#include "mesh/shapes.h"
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cagewright::test {

inline TriangleMesh scaled(TriangleMesh mesh, double scale, const Vec3& offset = Vec3::Zero()) {
  for (Vec3& p : mesh.positions) {
    p = scale * p + offset;
  }
  return mesh;
}

/// A sphere with bumps, longer than wide.
inline TriangleMesh bumpy_model(int subdivisions = 3) {
  TriangleMesh mesh = make_icosphere(subdivisions);
  for (Vec3& p : mesh.positions) {
    p *= 1 + 0.1 * std::sin(5 * p.x()) * std::cos(4 * p.y());
    p.z() *= 1.4;
  }
  return mesh;
}

/// The cage has 162 vertices, and much room.
struct ImproveScene {
  explicit ImproveScene(TriangleMesh m = bumpy_model(),
                        const TriangleMesh& c = scaled(make_icosphere(2), 2))
      : model(std::move(m)), surface(model), guard(surface, 0.01 * surface.diagonal),
        objective(surface, weights()), cage(c) {}

  [[nodiscard]] static ObjectiveWeights weights() {
    ObjectiveWeights result;
    result.typical_area = 0.1;
    return result;
  }
  /// Valid, and no nearer to the model than the clearance.
  void expect_sound() const {
    const TriangleMesh mesh = cage.mesh.compact();
    EXPECT_TRUE(validate_cage(mesh, model)->valid());
    for (const Triangle& t : mesh.triangles) {
      EXPECT_FALSE(
          surface.tree.too_near({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]},
                                (1 - 1e-9) * guard.clearance()));
    }
    expect_fresh_boxes();
  }
  [[nodiscard]] double total() const { return objective.total(cage.mesh); }

  TriangleMesh model;
  ModelSurface surface;
  Guard guard;
  Objective objective;
  WorkingCage cage;

private:
  /// The boxes beside the cage are those of its faces: each face finds itself.
  void expect_fresh_boxes() const {
    for (Index f = 0; f < cage.mesh.face_end(); ++f) {
      if (cage.mesh.has_face(f)) {
        std::vector<Index> found;
        const Vec3 middle =
            (cage.mesh.position(cage.mesh.face(f)[0]) + cage.mesh.position(cage.mesh.face(f)[1]) +
             cage.mesh.position(cage.mesh.face(f)[2])) /
            3;
        cage.boxes.find(Box3(middle), found);
        EXPECT_TRUE(std::find(found.begin(), found.end(), f) != found.end());
      }
    }
  }
};

/// Everything that is asked for is cancelled.
inline Progress stopped(StopFlag& source) {
  source.request_stop();
  return Progress(source);
}

} // namespace cagewright::test
