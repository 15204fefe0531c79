#include "cage/improve_to_gap.h"

#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <string>

namespace cagewright {
namespace {

/// An ellipsoid, and a fine cage round it to start from.
struct Scene {
  Scene() : model(make_icosphere(2)), start(make_icosphere(2)) {
    for (Vec3& p : model.positions) {
      p = p.cwiseProduct(Vec3(1, 0.8, 0.6));
    }
    for (Vec3& p : start.positions) {
      p = p.cwiseProduct(Vec3(1.15, 0.95, 0.75));
    }
  }
  [[nodiscard]] static ImproveOptions options(int vertices) {
    ImproveOptions result;
    result.vertices = vertices;
    result.rounds = 0;
    return result;
  }
  TriangleMesh model;
  TriangleMesh start;
};

TEST(ImproveToGap, ProvesTheGapOfAValidCage) {
  const Scene scene;
  constexpr double max_gap = 0.08;
  const Result<ImprovedToGap> made =
      improve_to_gap(scene.start, scene.model, Scene::options(0), max_gap);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->improved.report.reached) << made->improved.report.why_not;
  EXPECT_LE(made->gap, max_gap);
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
  const Scene scene;
  constexpr double max_gap = 0.05;
  const double d = diagonal(scene.model.positions);
  for (const double over : {1.0001, 1.02}) {
    const MeasureGap measure = [&](const TriangleMesh& cage, double) {
      GreatestGap gap;
      gap.upper = over * max_gap * d;
      gap.place = cage.positions[0];
      return gap;
    };
    const Result<ImprovedToGap> made =
        improve_to_gap(scene.start, scene.model, Scene::options(16), max_gap, measure);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_FALSE(made->improved.report.reached) << over;
    EXPECT_FALSE(made->improved.report.why_not.empty());
    EXPECT_NEAR(made->gap, over * max_gap, 1e-12);
  }
}

TEST(ImproveToGap, SaysWhyTheLimitOfVerticesDoesNotAllowTheGap) {
  const Scene scene;
  const Result<ImprovedToGap> made =
      improve_to_gap(scene.start, scene.model, Scene::options(12), 0.005);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->improved.report.reached);
  EXPECT_NE(made->improved.report.why_not.find("allow more vertices"), std::string::npos)
      << made->improved.report.why_not;
  EXPECT_LE(made->improved.cage.positions.size(), 12U);
  EXPECT_GT(made->gap, 0.005);
}

TEST(ImproveToGap, RefusesAGapBelowTheClearance) {
  const Scene scene;
  ImproveOptions options;
  options.clearance = 0.02;
  const Result<ImprovedToGap> made = improve_to_gap(scene.start, scene.model, options, 0.01);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::invalid_option);
}

TEST(ImproveToGap, StopsWhenAsked) {
  const Scene scene;
  StopFlag source;
  source.request_stop();
  const Result<ImprovedToGap> made = improve_to_gap(scene.start, scene.model, Scene::options(16),
                                                    0.05, Progress(source));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
