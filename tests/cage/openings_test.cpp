#include "cage/openings.h"

#include "mesh/shapes.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/model_volume.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

using Profile = std::vector<std::pair<double, double>>; // radius and height

/// A profile turned about the z axis: open where it begins and ends, or closed.
TriangleMesh turned(const Profile& profile, bool is_closed, Index around = 32) {
  PolygonMesh mesh;
  for (const auto& [radius, height] : profile) {
    for (Index k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  const auto rows = static_cast<Index>(profile.size());
  for (Index i = 0; i < rows - (is_closed ? 0 : 1); ++i) {
    for (Index k = 0; k < around; ++k) {
      const Index next = (k + 1) % around;
      const Index above = (i + 1) % rows * around;
      mesh.add_face({i * around + k, i * around + next, above + next, above + k});
    }
  }
  return to_triangle_mesh(mesh);
}

TriangleMesh dome() {
  Profile profile;
  for (int k = 0; k < 10; ++k) {
    const double angle = std::numbers::pi / 2 * k / 10;
    profile.emplace_back(std::cos(angle), std::sin(angle));
  }
  profile.emplace_back(1e-3, 1);
  return turned(profile, false);
}

TriangleMesh pipe_with_thick_walls() {
  return turned({{0.5, 0}, {0.5, 2}, {0.5, 3}, {0.4, 3}, {0.4, 2}, {0.4, 0}}, true);
}

TriangleMesh vase_with_thick_walls() {
  return turned({{1e-3, 0},
                 {0.7, 0},
                 {1, 0.8},
                 {0.6, 1.8},
                 {0.7, 2},
                 {0.6, 2},
                 {0.5, 1.8},
                 {0.9, 0.8},
                 {0.6, 0.15},
                 {1e-3, 0.15}},
                true);
}

TriangleMesh tilted(TriangleMesh mesh) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
  for (Vec3& p : mesh.positions) {
    p = turn * p;
  }
  return mesh;
}

/// Of the model with its closures.
double closed_volume(const TriangleMesh& model, double widest = 0) {
  const Result<Closures> closures = close_openings(model, widest);
  EXPECT_TRUE(closures) << closures.error().message;
  return model_volume(joined(model, closures->mesh)).value;
}

TEST(Openings, OfDomesAndPipesAreClosedAtTheRim) {
  constexpr double half_a_ball = 2 * std::numbers::pi / 3;
  EXPECT_NEAR(closed_volume(dome()), half_a_ball, 0.05 * half_a_ball);
  EXPECT_NEAR(closed_volume(tilted(dome())), half_a_ball, 0.05 * half_a_ball);
  const TriangleMesh pipe = turned({{0.5, 0}, {0.5, 1}, {0.5, 2}, {0.5, 3}}, false);
  const double filled = std::numbers::pi / 4 * 3;
  EXPECT_NEAR(closed_volume(pipe), filled, 0.05 * filled);
}

TEST(Openings, OfThickWallsAreFilled) {
  const double pipe = std::numbers::pi / 4 * 3;
  EXPECT_NEAR(closed_volume(pipe_with_thick_walls()), pipe, 0.08 * pipe);
  EXPECT_NEAR(closed_volume(tilted(pipe_with_thick_walls())), pipe, 0.12 * pipe);
  const TriangleMesh vase = vase_with_thick_walls();
  const TriangleMesh outside =
      turned({{1e-3, 0}, {0.7, 0}, {1, 0.8}, {0.6, 1.8}, {0.7, 2}, {1e-3, 2}}, true);
  const double filled = std::abs(signed_volume(outside));
  EXPECT_LT(std::abs(signed_volume(vase)), 0.5 * filled);
  EXPECT_NEAR(closed_volume(vase), filled, 0.05 * filled);
  EXPECT_NEAR(closed_volume(tilted(vase)), filled, 0.08 * filled);
}

TEST(Openings, LeaveTheHoleOfARingAndClosedShapes) {
  for (const TriangleMesh& model : {make_torus(0.2, 32, 12), make_icosphere(3), make_cube()}) {
    const Result<Closures> closures = close_openings(model, 0);
    ASSERT_TRUE(closures);
    EXPECT_EQ(closures->closed, 0);
    EXPECT_TRUE(closures->mesh.triangles.empty());
  }
}

TEST(Openings, StayOpenWhereTheyAreWiderThanAskedFor) {
  for (const TriangleMesh& model : {dome(), vase_with_thick_walls()}) {
    const Result<Closures> some = close_openings(model, 0.4);
    ASSERT_TRUE(some);
    EXPECT_EQ(some->too_wide, 1);
    const Result<Closures> all = close_openings(model, 2.5);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->too_wide, 0);
  }
}

TEST(Openings, ClosedGiveOneSolidCage) {
  const TriangleMesh model = dome();
  GenerateOptions options;
  options.vertices = 40;
  options.rounds = 2;
  options.solid = true;
  const Result<GeneratedCage> made = generate(model, options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->remarks.back().reason, Reason::openings_closed);
  EXPECT_GT(made->figures.volume, 2 * std::numbers::pi / 3) << "the dome and its inside";
  EXPECT_LT(made->figures.volume_ratio, 1.4) << "of the model with its opening closed";
  const auto judged = validate_cage(made->faces, TriangleView(model));
  EXPECT_TRUE(judged && judged->valid());
}

} // namespace
} // namespace cagewright
