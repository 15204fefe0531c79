#include <cagewright/coordinates/quad_mean_value.h>

#include "coordinates/laws.h"
#include "coordinates/quad_cages.h"
#include <cagewright/coordinates/mean_value.h>

#include <limits>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return quad_mean_value_coordinates(cage, {.accuracy = 1e-14});
}

TEST(QuadMeanValue, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> expected = {.3423473210, .1404785623, .2236163948, .0935577219,
                                        .0794447317, .0377293850, .0545915525, .0282343308};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], expected[c], 6e-11);
  }
  EXPECT_LT((moved(**made, golden_point(), golden_pose()) - Vec3(.3059096, .3763677, .24)).norm(),
            1e-7);
}

TEST(QuadMeanValue, IsMeanValueInCagesOfTriangles) {
  for (const PolygonMesh& cage : {make_star(), PolygonMesh(make_torus(0.35, 8, 5))}) {
    const Made made = make(cage);
    ASSERT_TRUE(made);
    const Result<MeanValueSolver> plain = MeanValueSolver::create(cage);
    ASSERT_TRUE(plain);
    std::vector<Vec3> points = points_inside(cage, 40, 51);
    for (const double distance : {1e-10, 1e-6, 1e-3}) {
      const std::vector<Vec3> near = points_inside_near(cage, distance, 10, 52);
      points.insert(points.end(), near.begin(), near.end());
    }
    for (const Vec3& x : points) {
      EXPECT_LT(relative_difference(solve(**made, x).weights, solve(*plain, x).weights), 1e-11)
          << x.transpose();
    }
  }
}

class QuadMeanValueIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
};

TEST_P(QuadMeanValueIn, SumsToOneAndReproducesAtAnyAccuracy) {
  for (const double accuracy : {0.0, 1e-8, 1e-14}) {
    const Made made = quad_mean_value_coordinates(cage(), {.accuracy = accuracy});
    ASSERT_TRUE(made);
    for (const Vec3& x : points_round(cage(), 60, 53)) {
      expect_partition_and_reproduction(**made, x, unit(), 1e-12);
    }
    for (const double distance : {1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
      for (const Vec3& x : points_by_patches(cage(), distance, 12, 54)) {
        expect_partition_and_reproduction(**made, x, unit(), 5e-12);
      }
    }
  }
}

TEST_P(QuadMeanValueIn, ComesAsNearAsAskedFor) {
  const Made exact = make(cage());
  ASSERT_TRUE(exact);
  for (const double accuracy : {1e-6, 1e-8}) {
    const Made made = quad_mean_value_coordinates(cage(), {.accuracy = accuracy});
    ASSERT_TRUE(made);
    std::vector<Vec3> points = points_inside(cage(), 40, 55);
    for (const double distance : {1e-5, 1e-3}) {
      const std::vector<Vec3> near = points_by_patches(cage(), distance, 10, 56);
      points.insert(points.end(), near.begin(), near.end());
    }
    for (const Vec3& x : points) {
      EXPECT_LT(relative_difference(solve(**made, x).weights, solve(**exact, x).weights),
                10 * accuracy)
          << x.transpose();
    }
  }
}

TEST_P(QuadMeanValueIn, InterpolatesOnItsPatches) {
  const Made made = make(cage());
  ASSERT_TRUE(made);
  Random random(57);
  for (std::size_t f = 0; f < cage().face_count(); ++f) {
    if (cage().face(f).size() != 4) {
      continue;
    }
    for (int i = 0; i < 4; ++i) {
      const PatchPoint on = point_of_patch(cage(), f, i, random);
      const Solved here = solve(**made, on.x);
      EXPECT_EQ(here.report.on_surface, 1);
      EXPECT_LT(relative_difference(here.weights, on.weights), 1e-11) << on.x.transpose();
      for (const double distance : {1e-3, 1e-5, 1e-7, 3e-9}) {
        const Vec3 near = on.x + distance * unit() * random_direction(random);
        EXPECT_LT(relative_difference(solve(**made, near).weights, on.weights),
                  300 * distance * std::log(1 / distance))
            << distance << ": " << on.x.transpose();
      }
    }
  }
}

TEST_P(QuadMeanValueIn, FollowsAffineMapsAndSimilarities) {
  const Made made = quad_mean_value_coordinates(cage());
  ASSERT_TRUE(made);
  const std::vector<Vec3> points = points_inside(cage(), 12, 58);
  expect_affine_maps_follow(**made, points, unit(), 1e-11);
  expect_similarities_follow(**made, points, unit(), 1e-11);
}

TEST_P(QuadMeanValueIn, DoesNotDependOnHowTheCageIsWritten) {
  expect_invariance(make, cage(), points_inside(cage(), 8, 59), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Laws, QuadMeanValueIn, testing::ValuesIn(quad_cages()),
                         [](const auto& tested) { return tested.param.name; });

TEST(QuadMeanValue, LeavesPointsThatAreNoneAlone) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made);
  const Solved solved = solve(**made, Vec3(0.5, std::numeric_limits<double>::quiet_NaN(), 0.5));
  EXPECT_EQ(solved.report.undefined, 1);
  EXPECT_EQ(largest(solved.weights), 0);
}

} // namespace
} // namespace cagewright
