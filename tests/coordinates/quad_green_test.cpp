#include <cagewright/coordinates/quad_green.h>

#include "coordinates/laws.h"
#include "coordinates/quad_cages.h"
#include <cagewright/coordinates/green.h>

#include <limits>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return quad_green_coordinates(cage, {.accuracy = 1e-14});
}

TEST(QuadGreen, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> phi = {.2712561434, .1355033760, .1901010456, .1016467124,
                                   .1001508234, .0655620480, .0791526115, .0566272397};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], phi[c], 6e-11);
  }
  const double unit = std::sqrt(3);
  const std::vector<double> psi = {.0569147616, .0493130810, .0388922298, .0434846960};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(weights[8 + k] / unit, psi[k], 6e-11);
  }
  EXPECT_LT(
      (moved(**made, golden_point(), golden_pose()) - Vec3(.3056262, .3635725, .2211338)).norm(),
      1e-7);
}

TEST(QuadGreen, IsGreenInCagesOfTriangles) {
  for (const PolygonMesh& cage : {make_star(), PolygonMesh(make_torus(0.35, 8, 5))}) {
    const Made made = make(cage);
    const Made plain = green_coordinates(cage);
    ASSERT_TRUE(made && plain);
    std::vector<Vec3> points = points_inside(cage, 40, 61);
    for (const double distance : {1e-8, 1e-6, 1e-3}) {
      const std::vector<Vec3> near = points_inside_near(cage, distance, 10, 62);
      points.insert(points.end(), near.begin(), near.end());
    }
    for (const Vec3& x : points) {
      EXPECT_LT(relative_difference(solve(**made, x).weights, solve(**plain, x).weights), 1e-11)
          << x.transpose();
    }
  }
}

class QuadGreenIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
};

TEST_P(QuadGreenIn, SumsToOneAndReproducesAtAnyAccuracy) {
  for (const double accuracy : {0.0, 1e-8, 1e-14}) {
    const Made made = quad_green_coordinates(cage(), {.accuracy = accuracy});
    ASSERT_TRUE(made);
    for (const Vec3& x : points_inside(cage(), 30, 63)) {
      if (solve(**made, x).report.outside == 0) { // it may lie between a quad and its diagonals
        expect_partition_and_reproduction(**made, x, unit(), 1e-12);
      }
    }
    for (const double distance : {0.0, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
      for (const Vec3& x : points_by_patches(cage(), distance, 12, 64)) {
        expect_partition_and_reproduction(**made, x, unit(), 1e-12);
      }
    }
  }
}

TEST_P(QuadGreenIn, ComesAsNearAsAskedFor) {
  const Made exact = make(cage());
  ASSERT_TRUE(exact);
  for (const double accuracy : {1e-6, 1e-8}) {
    const Made made = quad_green_coordinates(cage(), {.accuracy = accuracy});
    ASSERT_TRUE(made);
    for (const double distance : {1e-5, 1e-3, 1e-2, 1e-1}) {
      for (const Vec3& x : points_by_patches(cage(), distance, 12, 65)) {
        EXPECT_LT(relative_difference(solve(**made, x).weights, solve(**exact, x).weights),
                  10 * accuracy)
            << distance << ": " << x.transpose();
      }
    }
  }
}

TEST_P(QuadGreenIn, IsContinuousUpToTheCageAndThroughIt) {
  const Made made = quad_green_coordinates(
      cage(), {.accuracy = 1e-14, .outside = OutsideTreatment::continuation});
  ASSERT_TRUE(made);
  Random random(66);
  for (std::size_t f = 0; f < cage().face_count(); ++f) {
    if (cage().face(f).size() != 4) {
      continue;
    }
    const PatchPoint on = point_of_patch(cage(), f, 0, random);
    const std::vector<double> here = solve(**made, on.x).weights;
    for (const double distance : {1e-4, 1e-6, 1e-8}) {
      for (const double side : {-1.0, 1.0}) {
        const Vec3 near = on.x + side * distance * unit() * on.normal;
        EXPECT_LT(relative_difference(solve(**made, near).weights, here),
                  300 * distance * std::log(1 / distance))
            << side * distance << ": " << on.x.transpose();
      }
    }
  }
}

TEST_P(QuadGreenIn, TreatsPointsOutsideAsAsked) {
  const Made refusing = quad_green_coordinates(cage());
  const Made going_on = quad_green_coordinates(cage(), {.outside = OutsideTreatment::continuation});
  ASSERT_TRUE(refusing && going_on);
  for (const double distance : {1e-8, 1e-5, 1e-2, 0.1}) {
    for (const Vec3& x : points_by_patches(cage(), -distance, 10, 67)) {
      const Solved refused = solve(**refusing, x);
      if (refused.report.outside == 0) { // round a corner, inside again
        continue;
      }
      EXPECT_EQ(largest(refused.weights), 0);
      const Solved continued = solve(**going_on, x);
      const double most = std::max(1.0, largest(continued.weights));
      EXPECT_NEAR(sum_over_vertices(**going_on, continued.weights), 1, 1e-12 * most);
      EXPECT_LT((reproduced(continued.weights, (*going_on)->rule()->reproduced_from()) - x).norm(),
                1e-11 * most * unit())
          << x.transpose();
    }
  }
}

TEST_P(QuadGreenIn, FollowsSimilarities) {
  const Made made = quad_green_coordinates(cage());
  ASSERT_TRUE(made);
  expect_similarities_follow(**made, points_by_patches(cage(), 0.03, 12, 68), unit(), 1e-11);
}

TEST_P(QuadGreenIn, DoesNotDependOnHowTheCageIsWritten) {
  expect_invariance(make, cage(), points_by_patches(cage(), 0.03, 8, 69), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Laws, QuadGreenIn, testing::ValuesIn(quad_cages()),
                         [](const auto& tested) { return tested.param.name; });

TEST(QuadGreen, LeavesPointsThatAreNoneAlone) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made);
  const Solved solved = solve(**made, Vec3(0.5, std::numeric_limits<double>::quiet_NaN(), 0.5));
  EXPECT_EQ(solved.report.undefined, 1);
  EXPECT_EQ(largest(solved.weights), 0);
}

} // namespace
} // namespace cagewright
