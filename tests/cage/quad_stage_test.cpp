#include "cage/quad_stage.h"

#include "support/ground_scene.h"
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

namespace cagewright {
namespace {

/// Quads round an ellipsoid, of triangles that are made of a finer cage.
struct Scene : test::GroundScene {
  Scene() {
    options.quads = true;
    from.surface = start;
    from.clearance = options.clearance;
  }
  Result<QuadStage> run(const Progress& progress = {}) {
    const LimbRings none;
    return make_quads_in_budget({ground, from, options, none}, progress);
  }
  Start from;
  test::NotingGround ground{*this};
};

TEST(QuadStage, GivesAValidCageWithinTheNumberOfFaces) {
  Scene scene;
  scene.options.faces = 40;
  const Result<QuadStage> made = scene.run();
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->report.reached) << made->report.why_not;
  EXPECT_LE(made->made.cage.face_count(), 40U);
  EXPECT_TRUE(validate_cage(made->made.cage, scene.model)->valid());
  EXPECT_FALSE(made->gap) << "none was asked for";
}

TEST(QuadStage, CountsNoGapThatIsLargerThanAskedForAsKept) {
  constexpr double over = 1.02;
  Scene scene;
  scene.options.vertices = 24;
  scene.options.max_gap = 0.1;
  scene.ground.quads_are_at = over * scene.options.max_gap;
  const Result<QuadStage> made = scene.run();
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->report.reached);
  EXPECT_FALSE(made->report.why_not.empty());
  ASSERT_TRUE(made->gap);
  EXPECT_NEAR(*made->gap, over * scene.options.max_gap, 1e-12);
  EXPECT_GT(scene.ground.quads_measured, 1);
  EXPECT_LT(scene.ground.tolerances.back(), scene.ground.tolerances.front())
      << "triangles that are nearer are tried";
}

TEST(QuadStage, TakesTheFirstQuadsThatKeepTheGap) {
  Scene scene;
  scene.options.vertices = 24;
  scene.options.max_gap = 0.1;
  scene.ground.quads_are_at = scene.options.max_gap;
  const Result<QuadStage> made = scene.run();
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->report.reached) << made->report.why_not;
  EXPECT_EQ(scene.ground.quads_measured, 1);
}

TEST(QuadStage, StopsWhenAsked) {
  Scene scene;
  scene.options.faces = 40;
  StopFlag source;
  source.request_stop();
  const Result<QuadStage> made = scene.run(Progress(source));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
