#include "quads/relax_quads.h"

#include "quad_scene.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace cagewright {
namespace {

using test::QuadScene;

TEST(RelaxQuads, LowersTheObjectiveAndKeepsTheCageValidAlongEveryDiagonal) {
  QuadScene scene;
  ASSERT_GT(scene.count(4), 40U);
  scene.expect_sound();
  RelaxQuadsOptions one_step;
  one_step.steps = 1;
  double last = relax_quads(scene.cage, scene.guard, scene.objective, one_step);
  scene.expect_sound();
  for (int i = 0; i < 3; ++i) {
    const double value = relax_quads(scene.cage, scene.guard, scene.objective, one_step);
    EXPECT_LE(value, last * (1 + 1e-12));
    last = value;
    scene.expect_sound();
  }
}

TEST(RelaxQuads, ComesNearerToTheModelButNotNearerThanAsked) {
  QuadScene scene;
  const auto volume = [&] {
    double sum = 0;
    for (const Triangle& t : scene.cut(false).triangles) {
      const std::vector<Vec3>& p = scene.cage.positions();
      sum += p[t[0]].dot(p[t[1]].cross(p[t[2]])) / 6;
    }
    return sum;
  };
  const double before = volume();
  RelaxQuadsOptions options;
  options.keep = 0.05;
  relax_quads(scene.cage, scene.guard, scene.objective, options);
  EXPECT_LT(volume(), before);
  scene.expect_sound();
}

TEST(RelaxQuads, MakesRoomAtNoHigherPriceThanItMay) {
  const auto steps = [](int count, double most_rise) {
    RelaxQuadsOptions options;
    options.steps = count;
    options.keep = 0.3;
    options.most_rise = most_rise;
    return options;
  };
  QuadScene free;
  relax_quads(free.cage, free.guard, free.objective, {.steps = 30});
  QuadScene held = free;
  const double before = relax_quads(free.cage, free.guard, free.objective, {.steps = 0});
  EXPECT_GT(relax_quads(free.cage, free.guard, free.objective,
                        steps(8, std::numeric_limits<double>::infinity())),
            1.05 * before);
  EXPECT_LE(relax_quads(held.cage, held.guard, held.objective, steps(8, 0)), before * (1 + 1e-12));
  held.expect_sound();
}

TEST(RelaxQuads, KeepsTheFaces) {
  QuadScene scene;
  const QuadCage before = scene.cage;
  relax_quads(scene.cage, scene.guard, scene.objective, {});
  ASSERT_EQ(scene.cage.face_end(), before.face_end());
  for (Index f = 0; f < before.face_end(); ++f) {
    EXPECT_EQ(scene.cage.face(f).corners, before.face(f).corners);
  }
}

TEST(RelaxQuads, StopsWhenAsked) {
  QuadScene scene;
  const std::vector<Vec3> before = scene.cage.positions();
  StopFlag source;
  source.request_stop();
  relax_quads(scene.cage, scene.guard, scene.objective, {}, Progress(source));
  EXPECT_EQ(scene.cage.positions(), before);
}

} // namespace
} // namespace cagewright
