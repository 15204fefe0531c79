#include "support/models.h"
#include <cagewright/cage/generate.h>

#include <gtest/gtest.h>

#include <numbers>

namespace cagewright {
namespace {

// Its legs stand so near each other that voxels join them, or not, as it is turned.
class FreeLimbs : public testing::TestWithParam<double> {
protected:
  void SetUp() override {
    const auto model = test::real_model({"rigged_figure.glb"});
    if (!model) {
      GTEST_SKIP() << "no rigged_figure.glb in the folder that CAGEWRIGHT_MODELS names";
    }
    figure = *model;
    const Mat3 turn =
        Eigen::AngleAxisd(GetParam() * std::numbers::pi / 180, Vec3(1, 2, 3).normalized())
            .toRotationMatrix();
    for (Vec3& p : figure.positions) {
      p = turn * p;
    }
  }

  void expect_free(int vertices, double most_webbing) {
    const Result<GeneratedCage> made = generate(figure, {.vertices = vertices});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made->is_as_asked());
    EXPECT_LT(made->figures.webbing, most_webbing);
  }

  TriangleMesh figure;
};

TEST_P(FreeLimbs, OfAFigureHoweverItIsTurned) {
  expect_free(100, 0.02);
}

// The budget goes into the coarsest voxels first, which leave no gap at all.
TEST_P(FreeLimbs, OfAFigureWithFewVertices) {
  expect_free(60, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Degrees, FreeLimbs, testing::Values(0.0, 37.0, 200.0));

} // namespace
} // namespace cagewright
