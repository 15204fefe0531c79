#include "cage/quad_stage.h"

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <vector>

namespace cagewright {
namespace {

/// Quads round an ellipsoid, of triangles that are made of a finer cage.
struct Scene {
  Scene() : model(make_icosphere(2)), start(make_icosphere(2)) {
    for (Vec3& p : model.positions) {
      p = p.cwiseProduct(Vec3(1, 0.8, 0.6));
    }
    for (Vec3& p : start.positions) {
      p = p.cwiseProduct(Vec3(1.15, 0.95, 0.75));
    }
    options.improve.rounds = 0;
    options.quads = true;
  }

  Result<QuadStage> run(const MeasureQuadGap& gap_of, const Progress& progress = {}) {
    const MakeTriangles triangles = [&](int faces, double max_gap, const LimbRings&,
                                        const Progress& part) {
      gaps_asked.push_back(max_gap);
      ImproveOptions own = options.improve;
      own.faces = faces;
      return improve(start, model, own, part);
    };
    const LimbRings none;
    return make_quads_in_budget({triangles, gap_of, none, model, options, options.improve, size()},
                                progress);
  }
  [[nodiscard]] double size() const { return diagonal(model.positions); }
  /// Says of every cage that it is so many diagonals away.
  [[nodiscard]] MeasureQuadGap always(double gap) const {
    return [gap, d = size()](const PolygonMesh&, double) { return gap * d; };
  }

  TriangleMesh model;
  TriangleMesh start;
  BudgetCageOptions options;
  std::vector<double> gaps_asked;
};

TEST(QuadStage, GivesAValidCageWithinTheNumberOfFaces) {
  Scene scene;
  scene.options.improve.faces = 40;
  const Result<QuadStage> made = scene.run({});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->report.reached) << made->report.why_not;
  EXPECT_LE(made->made.cage.face_count(), 40U);
  EXPECT_TRUE(validate_cage(made->made.cage, scene.model)->valid());
  EXPECT_FALSE(made->gap) << "none was asked for";
}

TEST(QuadStage, CountsNoGapThatIsLargerThanAskedForAsKept) {
  constexpr double over = 1.02;
  Scene scene;
  scene.options.improve.vertices = 24;
  scene.options.max_gap = 0.05;
  const Result<QuadStage> made = scene.run(scene.always(over * scene.options.max_gap));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->report.reached);
  EXPECT_FALSE(made->report.why_not.empty());
  ASSERT_TRUE(made->gap);
  EXPECT_NEAR(*made->gap, over * scene.options.max_gap, 1e-12);
  ASSERT_GT(scene.gaps_asked.size(), 1U);
  EXPECT_LT(scene.gaps_asked.back(), scene.options.max_gap)
      << "triangles that are nearer are tried";
}

TEST(QuadStage, TakesTheFirstQuadsThatKeepTheGap) {
  Scene scene;
  scene.options.improve.vertices = 24;
  scene.options.max_gap = 0.05;
  const Result<QuadStage> made = scene.run(scene.always(scene.options.max_gap));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->report.reached) << made->report.why_not;
  EXPECT_EQ(scene.gaps_asked, std::vector<double>{0.05});
}

TEST(QuadStage, StopsWhenAsked) {
  Scene scene;
  scene.options.improve.faces = 40;
  StopFlag source;
  source.request_stop();
  const Result<QuadStage> made = scene.run({}, Progress(source));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
