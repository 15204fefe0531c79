// Compares with the optimiser of CGAL, which is a dependency of this test only.
#include "mesh/shapes.h"
#include "obb/minimum_box.h"
#include "obb/test_points.h"
#include "support/models.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/optimal_bounding_box.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cagewright {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

double reference_volume(const std::vector<Vec3>& points) {
  std::vector<Kernel::Point_3> copy;
  for (const Vec3& p : points) {
    copy.emplace_back(p.x(), p.y(), p.z());
  }
  std::array<Kernel::Point_3, 8> c;
  CGAL::oriented_bounding_box(copy, c);
  return std::sqrt(CGAL::squared_distance(c[0], c[1]) * CGAL::squared_distance(c[0], c[3]) *
                   CGAL::squared_distance(c[0], c[5]));
}

std::vector<Vec3> stretched(const TriangleMesh& mesh, const Vec3& by, std::uint64_t seed) {
  std::vector<Vec3> points;
  for (const Vec3& p : mesh.positions) {
    points.push_back(test::rotation(seed) * p.cwiseProduct(by));
  }
  return points;
}

void expect_within_one_percent(const std::vector<Vec3>& points) {
  const double reference = reference_volume(points);
  EXPECT_LE(minimum_box(points, {.extra_starts = 100}).volume(), 1.01 * reference);
}

TEST(ThoroughMinimumBox, IsWithinOnePercentOfTheReferenceForClouds) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    expect_within_one_percent(
        test::moved(test::points_in_box({1, 0.7, 0.5}, 20 << (seed % 5), seed),
                    test::rotation(seed), 1, {0, 0, 0}));
  }
}

TEST(ThoroughMinimumBox, IsWithinOnePercentOfTheReferenceForShapes) {
  expect_within_one_percent(stretched(make_icosphere(2), {1, 1, 1}, 1));
  expect_within_one_percent(stretched(make_icosphere(3), {3, 2, 1}, 2));
  expect_within_one_percent(stretched(make_torus(0.3, 40, 20), {1, 1, 1}, 3));
  expect_within_one_percent(stretched(make_torus(0.2, 40, 20), {1, 2, 3}, 4));
  expect_within_one_percent(
      stretched(joined(make_cube(), {stretched(make_cube(), {3, 0.2, 0.2}, 9), {}}), {1, 1, 1}, 5));
}

class MinimumBoxOf : public testing::TestWithParam<const char*> {};

TEST_P(MinimumBoxOf, IsWithinOnePercentOfTheReference) {
  const auto model = test::real_model({GetParam()});
  if (!model) {
    GTEST_SKIP() << "no " << GetParam() << " in CAGEWRIGHT_MODELS";
  }
  expect_within_one_percent(model->positions);
}

INSTANTIATE_TEST_SUITE_P(RealModels, MinimumBoxOf,
                         testing::Values("armadillo.off", "cow.off", "fandisk.off", "homer.off",
                                         "bull.off", "dino.off", "elk.off", "hand.off", "femur.off",
                                         "bunny.obj", "teapot.obj", "suzanne.obj"));

TEST(QuickMinimumBox, IsMostlyWithinOnePercentOfTheReference) {
  int within = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto points = test::moved(test::points_in_box({1, 0.7, 0.5}, 500, seed),
                                    test::rotation(seed), 1, {0, 0, 0});
    within += minimum_box(points).volume() <= 1.01 * reference_volume(points);
  }
  EXPECT_GE(within, 18);
}

} // namespace
} // namespace cagewright
