#include "cage/triangle_stage.h"
#include "spatial/bvh.h"
#include "support/ground_scene.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <string>

namespace cagewright {
namespace {

struct Scene : test::GroundScene {
  Result<Triangles> run(int vertices, double max_gap, const Progress& progress = {}) {
    options.vertices = vertices;
    return improve_to_gap(ground, start, ground.budget(options.clearance), max_gap, progress);
  }
  test::NotingGround ground{*this};
};

TEST(ImproveToGap, ProvesTheGapOfAValidCage) {
  Scene scene;
  constexpr double max_gap = 0.08;
  const Result<Triangles> made = scene.run(0, max_gap);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->improved.report.reached) << made->improved.report.why_not;
  EXPECT_LE(made->gap, max_gap);
  EXPECT_FALSE(made->farthest) << "no farther than was asked for";
  EXPECT_TRUE(validate_cage(made->improved.cage, scene.model)->valid());
  const double d = diagonal(scene.model.positions);
  const double measured =
      greatest_gap(made->improved.cage, TriangleBvh(scene.model), 1e-4 * d).upper / d;
  EXPECT_LE(measured, max_gap * 1.01);
  EXPECT_LT(made->improved.cage.positions.size(), scene.start.positions.size() / 2)
      << "a coarse one is enough";
}

// What decides is the measure: it says of every cage that it is a little too far away.
TEST(ImproveToGap, CountsNoGapThatIsLargerThanAskedForAsKept) {
  constexpr double max_gap = 0.05;
  for (const double over : {1.0001, 1.02}) {
    Scene scene;
    scene.ground.all_are_at = over * max_gap;
    const Result<Triangles> made = scene.run(16, max_gap);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_FALSE(made->improved.report.reached) << over;
    EXPECT_FALSE(made->improved.report.why_not.empty());
    ASSERT_TRUE(made->gap);
    EXPECT_NEAR(*made->gap, over * max_gap, 1e-12);
  }
}

TEST(ImproveToGap, SaysWhyAndWhereTheLimitOfVerticesDoesNotAllowTheGap) {
  Scene scene;
  const Result<Triangles> made = scene.run(12, 0.005);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->improved.report.reached);
  EXPECT_NE(made->improved.report.why_not.find("allow more vertices"), std::string::npos)
      << made->improved.report.why_not;
  EXPECT_LE(made->improved.cage.positions.size(), 12U);
  ASSERT_TRUE(made->gap);
  EXPECT_GT(*made->gap, 0.005);
  ASSERT_TRUE(made->farthest);
  const double off = TriangleBvh(scene.model).nearest(*made->farthest).distance;
  EXPECT_NEAR(off / diagonal(scene.model.positions), *made->gap, 1e-3);
}

TEST(ImproveToGap, RefusesAGapBelowTheClearance) {
  const Status can = can_keep_gap(0.01, 0.02);
  ASSERT_FALSE(can);
  EXPECT_EQ(can.error().code, ErrorCode::invalid_option);
}

TEST(ImproveToGap, StopsWhenAsked) {
  Scene scene;
  StopFlag source;
  source.request_stop();
  const Result<Triangles> made = scene.run(16, 0.05, Progress(source));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
