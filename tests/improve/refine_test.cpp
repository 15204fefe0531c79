#include "improve/refine.h"

#include "improve/relax.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright {
namespace {

constexpr Index tip = 8; // after the corners of the cube

// A cube in a larger cube with a pyramid on its right side, whose tip is far away.
class SpikedCage : public testing::Test {
protected:
  static TriangleMesh spiked() {
    TriangleMesh mesh = make_cube();
    const Vec3 center = bounding_box(TriangleView(mesh)).center();
    std::vector<Triangle> kept;
    std::vector<Triangle> right;
    for (const Triangle& t : mesh.triangles) {
      const bool is_right = std::all_of(
          t.begin(), t.end(), [&](Index v) { return mesh.positions[v].x() > center.x(); });
      (is_right ? right : kept).push_back(t);
    }
    for (const Triangle& t : right) { // the sides of the two triangles that are not shared
      for (int k = 0; k < 3; ++k) {
        const Index a = t[k];
        const Index b = t[(k + 1) % 3];
        const bool shared = std::any_of(right.begin(), right.end(), [&](const Triangle& s) {
          return &s != &t &&
                 std::count(s.begin(), s.end(), a) + std::count(s.begin(), s.end(), b) == 2;
        });
        if (!shared) {
          kept.push_back({a, b, tip});
        }
      }
    }
    for (Vec3& p : mesh.positions) {
      p = center + 1.2 * (p - center);
    }
    mesh.positions.push_back(center + Vec3(2, 0, 0));
    mesh.triangles = kept;
    return mesh;
  }

  static ObjectiveWeights weights() {
    ObjectiveWeights result;
    result.typical_area = 0.5;
    return result;
  }

  TriangleMesh model_ = make_cube();
  ModelSurface surface_{model_};
  Guard guard_{surface_, 0.01 * surface_.diagonal};
  Objective objective_{surface_, weights()};
  WorkingCage cage_{spiked()};
};

TEST_F(SpikedCage, GetsABluntTipWithOneVertexMore) {
  ASSERT_TRUE(validate_cage(cage_.mesh.compact(), model_)->valid());
  const double before = objective_.total(cage_.mesh);
  const double far = objective_.nearest(cage_.mesh.position(tip)).distance;
  const std::size_t count = cage_.mesh.vertex_count();
  ASSERT_TRUE(split_tip(cage_, guard_, objective_, tip, 10));
  EXPECT_EQ(cage_.mesh.vertex_count(), count + 1);
  EXPECT_TRUE(validate_cage(cage_.mesh.compact(), model_)->valid());
  EXPECT_LT(objective_.total(cage_.mesh), before);
  EXPECT_LT(objective_.nearest(cage_.mesh.position(tip)).distance, 0.75 * far);
}

TEST_F(SpikedCage, KeepsItsTipWhereEveryCornerHasTheMostFacesAlready) {
  const TriangleMesh before = cage_.mesh.compact();
  EXPECT_FALSE(split_tip(cage_, guard_, objective_, tip, 4));
  EXPECT_EQ(cage_.mesh.compact().positions, before.positions);
  EXPECT_EQ(cage_.mesh.compact().triangles, before.triangles);
}

TEST_F(SpikedCage, KeepsItsShapeWhenLongEdgesAreSplit) {
  const double volume = signed_volume(cage_.mesh.compact());
  constexpr std::size_t asked = 80;
  constexpr std::size_t most_valence = 8;
  split_long_edges(cage_, guard_, asked, most_valence);
  const TriangleMesh split = cage_.mesh.compact();
  EXPECT_EQ(split.positions.size(), asked);
  EXPECT_TRUE(validate_cage(split, model_)->valid());
  EXPECT_NEAR(signed_volume(split), volume, 1e-12);
  double longest = 0;
  for (Index v = 0; v < split.positions.size(); ++v) {
    const std::vector<Index> beside = cage_.mesh.neighbors(v);
    EXPECT_LE(beside.size(), most_valence);
    for (const Index w : beside) {
      longest = std::max(longest, (split.positions[v] - split.positions[w]).norm());
    }
  }
  const double whole = (split.positions[tip] - split.positions[1]).norm();
  EXPECT_LT(longest, 0.7 * whole);
}

TEST_F(SpikedCage, MovesOnlyTheVerticesThatMay) {
  const TriangleMesh before = cage_.mesh.compact();
  const double value = objective_.total(cage_.mesh);
  const std::vector<Index> movable = {0, tip};
  relax(cage_, guard_, objective_, {.steps = 4, .movable = movable});
  const TriangleMesh after = cage_.mesh.compact();
  for (Index v = 0; v < before.positions.size(); ++v) {
    const bool may = std::find(movable.begin(), movable.end(), v) != movable.end();
    EXPECT_EQ(after.positions[v] != before.positions[v], may) << v;
  }
  EXPECT_LT(objective_.total(cage_.mesh), value);
  EXPECT_TRUE(validate_cage(after, model_)->valid());
}

// What a union of boxes may leave: vertices that ought to be one, and hardly a face between them.
TEST_F(SpikedCage, LosesItsNeedles) {
  Patch patch = cage_.mesh.split(tip, cage_.mesh.neighbors(tip)[0]);
  patch.position = cage_.mesh.position(tip) - Vec3(1e-9, 0, 0);
  cage_.apply(patch);
  Patch speck = cage_.mesh.split(tip, patch.vertex);
  cage_.apply(speck);
  constexpr double least = 0.05;
  const auto needles = [&] {
    std::size_t count = 0;
    for (Index f = 0; f < cage_.mesh.face_end(); ++f) {
      count += cage_.mesh.has_face(f) && shape_quality(corners_of(cage_.mesh, f)) < least ? 1 : 0;
    }
    return count;
  };
  ASSERT_EQ(needles(), 4);
  EXPECT_EQ(mend_needles(cage_, guard_, objective_, least, 10), 2);
  EXPECT_EQ(needles(), 0);
  EXPECT_EQ(cage_.mesh.vertex_count(), spiked().positions.size());
  EXPECT_TRUE(validate_cage(cage_.mesh.compact(), model_)->valid());
}

TEST_F(SpikedCage, LosesNeedlesByMovesWhereNoEdgeMayGo) {
  Patch patch = cage_.mesh.split(tip, cage_.mesh.neighbors(tip)[0]);
  patch.position = cage_.mesh.position(tip) - Vec3(0.01, 0, 0);
  cage_.apply(patch);
  const std::size_t vertices = cage_.mesh.vertex_count();
  constexpr std::size_t no_change_of_valence = 3;
  EXPECT_GT(mend_needles(cage_, guard_, objective_, 0.05, no_change_of_valence), 0);
  EXPECT_EQ(cage_.mesh.vertex_count(), vertices);
  EXPECT_EQ(cage_.mesh.compact().positions.size(), vertices);
  EXPECT_TRUE(validate_cage(cage_.mesh.compact(), model_)->valid());
}

TEST_F(SpikedCage, WithoutNeedlesStaysAsItIs) {
  const TriangleMesh before = cage_.mesh.compact();
  EXPECT_EQ(mend_needles(cage_, guard_, objective_, 0.05, 10), 0);
  EXPECT_EQ(cage_.mesh.compact().positions, before.positions);
}

} // namespace
} // namespace cagewright
