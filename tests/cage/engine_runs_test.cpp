#include "cage/engine_runs.h"

#include "cage/quad_stage.h"
#include "cage/triangle_stage.h"
#include "support/ground_scene.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

// However little a stage is content with: what has been begun is finished, and no more.
TEST(EngineRuns, AreNotBegunOnceTheyAreUsedUp) {
  for (const bool quads : {false, true}) {
    for (const double max_gap : {0.0, 0.02}) {
      test::GroundScene scene;
      scene.options.vertices = 12;
      scene.options.faces = quads ? 12 : 0;
      scene.options.max_gap = max_gap;
      test::NotingGround ground(scene);
      ground.all_are_at = 0.5; // never near enough
      while (scene.runs.are_left()) {
        scene.runs.use_one();
      }
      const int before = scene.runs.used();
      if (quads) {
        Start from;
        from.surface = scene.start;
        from.clearance = scene.options.clearance;
        const LimbRings none;
        ASSERT_TRUE(make_quads_in_budget({ground, from, scene.options, none}));
      } else if (max_gap > 0) {
        ASSERT_TRUE(improve_to_gap(ground, scene.start, ground.budget(0.002), max_gap));
      } else {
        ASSERT_TRUE(improve_well_shaped(ground, scene.start, ground.budget(0.002)));
      }
      EXPECT_LE(scene.runs.used() - before, most_to_finish / 2 - 1)
          << (quads ? "quads" : "triangles") << ", gap " << max_gap;
    }
  }
}

} // namespace
} // namespace cagewright
