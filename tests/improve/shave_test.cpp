#include "improve/shave.h"

#include "mesh/shapes.h"
#include "symmetry/half.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>

namespace cagewright {
namespace {

constexpr std::size_t most_valence = 10;

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& p : mesh.positions) {
    p *= factor;
  }
  return mesh;
}

/// A ball with a mushroom on its first face, three vertices to a ring, of which the last three are
/// the top.
TriangleMesh ball_with_a_knob(double radius, double cap = 0.9) {
  TriangleMesh mesh = scaled(make_icosphere(1), radius);
  std::array<Index, 3> below = mesh.triangles.front();
  mesh.triangles.erase(mesh.triangles.begin());
  std::array<Vec3, 3> base;
  std::transform(below.begin(), below.end(), base.begin(),
                 [&](Index v) { return mesh.positions[v]; });
  const Vec3 center = (base[0] + base[1] + base[2]) / 3;
  for (const auto& [height, width] : {std::pair(0.2, 0.5), std::pair(0.5, cap)}) {
    std::array<Index, 3> ring{};
    for (std::size_t k = 0; k < 3; ++k) {
      ring[k] = static_cast<Index>(mesh.positions.size());
      mesh.positions.emplace_back((1 + height) * center + width * (base[k] - center));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      mesh.triangles.push_back({below[k], below[next], ring[next]});
      mesh.triangles.push_back({below[k], ring[next], ring[k]});
    }
    below = ring;
  }
  mesh.triangles.push_back(below);
  return mesh;
}

struct Shaving {
  explicit Shaving(TriangleMesh start, TriangleMesh inside, CageExtent extent = CageExtent::whole)
      : model(std::move(inside)), surface(model), guard(surface, 0.005 * surface.diagonal),
        objective(surface, weights()), cage(start, extent) {}

  static ObjectiveWeights weights() {
    ObjectiveWeights result;
    result.typical_area = 0.2;
    return result;
  }

  [[nodiscard]] double farthest() const {
    double most = 0;
    for (const Vec3& p : cage.mesh.compact().positions) {
      most = std::max(most, objective.nearest(p).distance);
    }
    return most;
  }

  TriangleMesh model;
  ModelSurface surface;
  Guard guard;
  Objective objective;
  WorkingCage cage;
};

TEST(ShaveTip, TakesAKnobOff) {
  Shaving s(ball_with_a_knob(1.2), make_icosphere(2));
  ASSERT_TRUE(validate_cage(s.cage.mesh.compact(), s.model)->valid());
  const std::size_t count = s.cage.mesh.vertex_count();
  const double before = s.objective.total(s.cage.mesh);
  const double far = s.farthest();
  const Index tip = s.cage.mesh.vertex_end() - 1;
  ASSERT_TRUE(shave_tip(s.cage, s.guard, s.objective, tip, most_valence));
  EXPECT_LT(s.cage.mesh.vertex_count(), count);
  EXPECT_LT(s.objective.total(s.cage.mesh), before);
  EXPECT_LT(s.farthest(), 0.5 * far);
  for (Index v = 0; v < s.cage.mesh.vertex_end(); ++v) {
    EXPECT_LE(s.cage.mesh.valence(v), most_valence);
  }
  EXPECT_TRUE(validate_cage(s.cage.mesh.compact(), s.model)->valid());
}

// Tips in the mirror plane are drawn in within it, though there are ends beside it.
TEST(ShaveTip, KeepsTheBorderOfAHalfInItsPlane) {
  TriangleMesh ball = ball_with_a_knob(1.2, 6); // what is under the cap finds no place
  const Triangle top = ball.triangles.back();
  const Vec3 up = ball.positions[top[0]] + ball.positions[top[1]] + ball.positions[top[2]];
  std::size_t shaved = 0;
  for (int degrees = 0; degrees < 120; degrees += 10) {
    TriangleMesh turned = ball;
    const Mat3 turn = (Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()) *
                       Eigen::Quaterniond::FromTwoVectors(up, Vec3::UnitZ()))
                          .toRotationMatrix();
    for (Vec3& p : turned.positions) {
      p = turn * p;
    }
    const std::optional<TriangleMesh> half = cut_half(turned);
    ASSERT_TRUE(half);
    for (Index v = 0; v < half->positions.size(); ++v) {
      if (half->positions[v].x() != 0 || half->positions[v].z() < 1.5) {
        continue;
      }
      Shaving s(*half, make_icosphere(2), CageExtent::half);
      shaved += shave_tip(s.cage, s.guard, s.objective, v, most_valence) ? 1 : 0;
      for (Index w = 0; w < s.cage.mesh.vertex_end(); ++w) {
        EXPECT_TRUE(!s.cage.mesh.on_plane(w) || s.cage.mesh.position(w).x() == 0);
      }
    }
  }
  EXPECT_GT(shaved, 0U);
}

TEST(ShaveTip, LeavesACornerThatIsNoFartherThanItMustBe) {
  TriangleMesh box = make_cube();
  const Vec3 center = bounding_box(TriangleView(box)).center();
  for (Vec3& p : box.positions) {
    p = center + 1.04 * (p - center);
  }
  Shaving s(box, make_cube());
  ASSERT_TRUE(validate_cage(box, s.model)->valid());
  const TriangleMesh before = s.cage.mesh.compact();
  EXPECT_FALSE(shave_tip(s.cage, s.guard, s.objective, 0, most_valence));
  EXPECT_EQ(s.cage.mesh.compact().positions, before.positions);
  EXPECT_EQ(s.cage.mesh.compact().triangles, before.triangles);
}

} // namespace
} // namespace cagewright
