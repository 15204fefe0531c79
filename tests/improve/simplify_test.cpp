#include "improve/simplify.h"

#include "improve_scene.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

using test::ImproveScene;

class SimplifyBy : public testing::TestWithParam<Placement> {};

TEST_P(SimplifyBy, ReachesTheNumberOfVerticesAndKeepsTheCageValid) {
  ImproveScene scene;
  SimplifyOptions options;
  options.vertices = 40;
  options.placement = GetParam();
  EXPECT_TRUE(simplify(scene.cage, scene.guard, scene.objective, options));
  EXPECT_EQ(scene.cage.mesh.vertex_count(), 40U);
  scene.expect_sound();
  for (Index v = 0; v < scene.cage.mesh.vertex_end(); ++v) {
    EXPECT_LE(scene.cage.mesh.valence(v), options.most_valence);
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, SimplifyBy,
                         testing::Values(Placement::outside_patch, Placement::clear_of_model),
                         [](const auto& placement) {
                           return placement.param == Placement::outside_patch ? "OutsidePatch"
                                                                              : "ClearOfModel";
                         });

TEST(Simplify, KeepsPartsThatAreSmallInside) {
  TriangleMesh model = test::bumpy_model();
  for (const Vec3& at : {Vec3(1.5, 0, 0), Vec3(0, 1.5, 0), Vec3(-1, -1, 0.6), Vec3(0, 0.2, 1.8)}) {
    model = joined(model, test::scaled(make_tetrahedron(), 0.003, at));
  }
  ImproveScene scene(model);
  SimplifyOptions options;
  options.vertices = 16;
  EXPECT_TRUE(simplify(scene.cage, scene.guard, scene.objective, options));
  scene.expect_sound();
}

TEST(Simplify, StopsWhenAskedWithAValidCage) {
  ImproveScene scene;
  StopFlag source;
  EXPECT_FALSE(simplify(scene.cage, scene.guard, scene.objective, {}, test::stopped(source)));
  scene.expect_sound();
}

TEST(Simplify, LeavesACageWithinTheNumberAlone) {
  ImproveScene scene;
  const TriangleMesh before = scene.cage.mesh.compact();
  SimplifyOptions options;
  options.vertices = before.positions.size();
  EXPECT_TRUE(simplify(scene.cage, scene.guard, scene.objective, options));
  EXPECT_EQ(scene.cage.mesh.compact().positions, before.positions);
}

} // namespace
} // namespace cagewright
