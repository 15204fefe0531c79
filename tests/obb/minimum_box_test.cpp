#include "obb/minimum_box.h"

#include "mesh/shapes.h"
#include "obb/principal_axes.h"
#include "obb/test_points.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

void expect_contains(const OrientedBox& box, std::span<const Vec3> points) {
  for (const Vec3& p : points) {
    ASSERT_TRUE(box.contains(p, 1e-9 * box.half.norm()));
  }
}

TEST(MinimumBox, FindsTurnedBoxes) {
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    Random random(seed);
    const Vec3 half(random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1));
    auto points = test::points_in_box(half, 300, seed);
    for (const Vec3& corner : OrientedBox{Vec3::Zero(), Mat3::Identity(), half}.corners()) {
      points.push_back(corner);
    }
    points = test::moved(points, test::rotation(seed), 1, {1, 2, 3});
    const OrientedBox box = minimum_box(points);
    EXPECT_NEAR(box.volume() / (8 * half.prod()), 1, 1e-4) << seed;
    expect_contains(box, points);
  }
}

TEST(MinimumBox, IsNeverLargerThanThePcaBoxAndContainsAllPoints) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    Random random(seed);
    const Vec3 half(1, random.uniform(0.01, 1), random.uniform(0.01, 1));
    const int count = 1 + static_cast<int>(random.below(200));
    const auto points =
        test::moved(test::points_in_box(half, count, seed), test::rotation(seed), 1, {9, 9, 9});
    const OrientedBox box = minimum_box(points, {.extra_starts = static_cast<int>(seed % 3)});
    EXPECT_LE(box.volume(), pca_box(points).volume());
    expect_contains(box, points);
    EXPECT_GE(box.half[0], box.half[1]);
    EXPECT_GE(box.half[1], box.half[2]);
    EXPECT_GT(box.axes.determinant(), 0.999999);
  }
}

TEST(MinimumBox, OfAnOctahedronIsTheKnownOne) {
  // 8/27 of its bounding cube: no face of the box is parallel to one of the octahedron.
  const std::vector<Vec3> points = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  EXPECT_NEAR(minimum_box(points, {.extra_starts = 1000}).volume(), 64.0 / 27, 0.01);
}

TEST(MinimumBox, OfATetrahedronIsItsCube) {
  const auto points = test::moved(make_tetrahedron().positions, test::rotation(2), 1, {0, 0, 0});
  EXPECT_NEAR(minimum_box(points).volume(), 8, 1e-3);
}

TEST(MinimumBox, OfFlatPointsIsTheLeastRectangle) {
  std::vector<Vec3> points = {{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}, {0, 0, 0}};
  points = test::moved(points, test::rotation(6), 1, {1, 2, 3});
  const OrientedBox box = minimum_box(points);
  EXPECT_NEAR(box.half[0], 2, 1e-6);
  EXPECT_NEAR(box.half[1], 1, 1e-6);
  EXPECT_NEAR(box.half[2], 0, 1e-6);
}

TEST(MinimumBox, OfPointsOnALineIsTheSegment) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 10; ++i) {
    points.push_back(Vec3(1, 1, 1) + i * Vec3(1, 2, -2) / 30);
  }
  const OrientedBox box = minimum_box(points);
  EXPECT_NEAR(box.half[0], 0.5, 1e-6);
  EXPECT_NEAR(box.half[1], 0, 1e-6);
  EXPECT_NEAR(box.half[2], 0, 1e-6);
}

TEST(MinimumBox, OfOnePointOrNoneHasNoExtent) {
  const std::vector<Vec3> same(4, Vec3(3, 4, 5));
  EXPECT_EQ(minimum_box(same).volume(), 0);
  EXPECT_EQ(minimum_box(same).center, Vec3(3, 4, 5));
  EXPECT_EQ(minimum_box({}).volume(), 0);
}

TEST(MinimumBox, OfManyPointsOfASphereIsFoundSoon) {
  // All boxes are alike: a search that goes on for each little gain takes minutes.
  std::vector<Vec3> points;
  Random random(1);
  while (points.size() < 200'000) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (p.norm() > 0.1) {
      points.push_back(p.normalized());
    }
  }
  const double volume = minimum_box(points).volume();
  EXPECT_NEAR(volume, 8, 0.02);
}

TEST(MinimumBox, ScalesWithThePoints) {
  const auto points =
      test::moved(test::points_in_box({1, 0.8, 0.5}, 200, 8), test::rotation(8), 1, {0, 0, 0});
  const double volume = minimum_box(points).volume();
  for (const double scale : {1e-6, 1e6}) {
    const auto copy = test::moved(points, Mat3::Identity(), scale, scale * Vec3(3e4, 2e4, 1e4));
    EXPECT_NEAR(minimum_box(copy).volume() / (scale * scale * scale) / volume, 1, 1e-3);
  }
}

TEST(MinimumBox, UsesTheFramesItIsGiven) {
  int missed = 0;
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    const auto points = test::points_in_box({1, 0.9, 0.8}, 30, seed);
    const OrientedBox best = minimum_box(points, {.extra_starts = 100});
    missed += minimum_box(points, {.extra_starts = 0}).volume() > 1.01 * best.volume();
    const std::vector<Mat3> seeds = {best.axes};
    EXPECT_LE(minimum_box(points, {.extra_starts = 0, .seeds = seeds}).volume(),
              best.volume() * (1 + 2e-4));
  }
  EXPECT_GT(missed, 0) << "the frames given made no difference";
}

} // namespace
} // namespace cagewright
