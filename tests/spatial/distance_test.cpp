#include "spatial/distance.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

Vec3 random_point(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// The least distance from p to a fine lattice of points of the triangle: never below the true one.
double sampled_distance(const Vec3& p, const Vec3 (&t)[3]) {
  constexpr int fine = 60;
  double least = HUGE_VAL;
  for (int i = 0; i <= fine; ++i) {
    for (int j = 0; i + j <= fine; ++j) {
      const Vec3 x = (t[0] * i + t[1] * j + t[2] * (fine - i - j)) / fine;
      least = std::min(least, (p - x).norm());
    }
  }
  return least;
}

TEST(NearestOnTriangle, IsNoFartherThanAnyPointOfTheTriangle) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    Vec3 t[3] = {random_point(random), random_point(random), random_point(random)};
    if (i % 5 == 0) {
      // A segment, to rounding or nearly, with either corner between the others.
      t[i % 3] = t[(i + 1) % 3] + 0.3 * (t[(i + 2) % 3] - t[(i + 1) % 3]) +
                 std::pow(10, -static_cast<double>(i % 16)) * random_point(random);
    }
    const Vec3 p = 1.5 * random_point(random);
    const double distance = point_triangle_distance(p, t[0], t[1], t[2]);
    const double sampled = sampled_distance(p, t);
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_GE(distance, sampled - 0.06);
  }
}

TEST(NearestOnTriangle, OfACollapsedTriangleIsOnIt) {
  const Vec3 a(1, 2, 3);
  EXPECT_EQ(nearest_on_triangle({0, 0, 0}, a, a, a), a);
  EXPECT_EQ(nearest_on_triangle({2, 5, 3}, a, a, {3, 2, 3}), Vec3(2, 2, 3));
}

TEST(SegmentSegmentClosest, FindsCrossingsParallelsAndPoints) {
  EXPECT_EQ(segment_segment_closest({-1, 0, 0}, {1, 0, 0}, {0, -1, 2}, {0, 1, 2}).distance, 2);
  EXPECT_EQ(segment_segment_closest({0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {2, 1, 0}).distance,
            std::sqrt(2));
  EXPECT_EQ(segment_segment_closest({0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {2, 1, 0}).distance, 1);
  EXPECT_EQ(segment_segment_closest({0, 0, 0}, {0, 0, 0}, {1, 1, 0}, {1, -1, 0}).distance, 1);
}

TEST(TriangleTriangleDistance, IsThatOfTheNearestPoints) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec3 shift = 2 * random_point(random);
    const Vec3 a[3] = {random_point(random), random_point(random), random_point(random)};
    const Vec3 b[3] = {random_point(random) + shift, random_point(random) + shift,
                       random_point(random) + shift};
    const ClosestPoints closest = triangle_triangle_closest(a, b);
    EXPECT_NEAR((closest.on_a - closest.on_b).norm(), closest.distance, 1e-12);
    EXPECT_NEAR(point_triangle_distance(closest.on_a, a[0], a[1], a[2]), 0, 1e-12);
    EXPECT_NEAR(point_triangle_distance(closest.on_b, b[0], b[1], b[2]), 0, 1e-12);
    // No point of a sample of a is nearer to b.
    constexpr int fine = 30;
    for (int k = 0; k <= fine; ++k) {
      for (int l = 0; k + l <= fine; ++l) {
        const Vec3 x = (a[0] * k + a[1] * l + a[2] * (fine - k - l)) / fine;
        ASSERT_GE(point_triangle_distance(x, b[0], b[1], b[2]), closest.distance - 1e-12);
      }
    }
  }
}

TEST(TriangleTriangleDistance, IsZeroWhereTheyCross) {
  const Vec3 a[3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const Vec3 b[3] = {{0, 0, -1}, {0.1, 0, 1}, {-0.1, 0.1, 1}};
  EXPECT_EQ(triangle_triangle_distance(a, b), 0);
  EXPECT_EQ(triangle_triangle_distance(b, a), 0);
}

} // namespace
} // namespace cagewright
