#include "improve/relax.h"

#include "core/random.h"
#include "improve_scene.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

using test::ImproveScene;
using test::scaled;

TEST(Relax, LowersTheObjectiveAndKeepsTheCageValid) {
  ImproveScene scene;
  const double before = scene.total();
  const double value = relax(scene.cage, scene.guard, scene.objective, {});
  EXPECT_LT(value, before);
  EXPECT_NEAR(value, scene.total(), 1e-9 * before);
  scene.expect_sound();
  const double again = relax(scene.cage, scene.guard, scene.objective, {});
  EXPECT_LE(again, value);
  scene.expect_sound();
}

TEST(Relax, MovesNoneButTheMovable) {
  ImproveScene scene;
  const CageMesh before = scene.cage.mesh;
  const std::vector<Index> movable = {0, 5, 17};
  RelaxOptions options;
  options.movable = movable;
  relax(scene.cage, scene.guard, scene.objective, options);
  std::vector<Index> moved;
  for (Index v = 0; v < before.vertex_end(); ++v) {
    if (scene.cage.mesh.position(v) != before.position(v)) {
      moved.push_back(v);
    }
  }
  EXPECT_EQ(moved, movable);
  scene.expect_sound();
}

// Between two steps a vertex may be carried past what is small: nothing that a face touches, then
// or now, tells of it.
TEST(Relax, LosesNoPartOfTheModelHoweverLongItsSteps) {
  Random random(7);
  int moved = 0;
  for (int trial = 0; trial < 8; ++trial) {
    TriangleMesh model = scaled(make_icosphere(2), 0.3);
    for (int i = 0; i < 12; ++i) {
      const Vec3 at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      model = joined(model,
                     scaled(make_tetrahedron(), 0.004, at.normalized() * random.uniform(0.4, 1.2)));
    }
    ImproveScene scene(model, scaled(make_icosphere(1), 1.6));
    const Guard guard(scene.surface, 1e-4 * scene.surface.diagonal);
    RelaxOptions options;
    options.first_step = 0.5;
    const TriangleMesh before = scene.cage.mesh.compact();
    relax(scene.cage, guard, scene.objective, options);
    const TriangleMesh after = scene.cage.mesh.compact();
    EXPECT_TRUE(validate_cage(after, model)->valid()) << "trial " << trial;
    moved += after.positions != before.positions ? 1 : 0;
  }
  EXPECT_GT(moved, 0);
}

TEST(Relax, StopsWhenAsked) {
  ImproveScene scene;
  const TriangleMesh before = scene.cage.mesh.compact();
  StopFlag source;
  relax(scene.cage, scene.guard, scene.objective, {}, test::stopped(source));
  EXPECT_EQ(scene.cage.mesh.compact().positions, before.positions);
}

} // namespace
} // namespace cagewright
