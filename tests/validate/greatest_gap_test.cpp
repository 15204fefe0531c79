#include "validate/greatest_gap.h"

#include "core/random.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& p : mesh.positions) {
    p *= factor;
  }
  return mesh;
}

TEST(GreatestGap, OfACubeRoundACubeIsThatOfTheCorners) {
  const TriangleBvh model(make_cube());
  const GreatestGap gap = greatest_gap(scaled(make_cube(), 2), model, 1e-6);
  EXPECT_NEAR(gap.lower, std::sqrt(3), 1e-12);
  EXPECT_LE(gap.upper, gap.lower + 1e-6);
  EXPECT_NEAR(gap.place.norm(), 2 * std::sqrt(3), 1e-12);
}

TEST(GreatestGap, IsFoundInsideFacesToo) {
  // The middle of a large face is above a hole: no corner is as far.
  TriangleMesh model = make_torus(0.1, 64, 16);
  const TriangleMesh lid{{{-2, -2, 0.2}, {2, -2, 0.2}, {2, 2, 0.2}, {-2, 2, 0.2}},
                         {{0, 1, 2}, {0, 2, 3}}};
  const GreatestGap gap = greatest_gap(lid, TriangleBvh(model), 1e-6);
  EXPECT_NEAR(gap.lower, std::hypot(std::sqrt(8) - 1, 0.2) - 0.1, 1e-2);
  const TriangleMesh small_lid = scaled(lid, 0.2);
  const GreatestGap middle = greatest_gap(small_lid, TriangleBvh(model), 1e-6);
  EXPECT_LT(middle.place.norm(), 0.1);
}

TEST(GreatestGap, BoundsEveryPoint) {
  Random random(11);
  const TriangleMesh model = make_icosphere(2);
  TriangleMesh cage = scaled(make_icosphere(1), 1.5);
  for (Vec3& p : cage.positions) {
    p *= random.uniform(1, 1.3);
  }
  const TriangleBvh bvh(model);
  for (const double tolerance : {0.1, 0.01, 0.0001}) {
    const GreatestGap gap = greatest_gap(cage, bvh, tolerance);
    EXPECT_LE(gap.lower, gap.upper);
    EXPECT_LE(gap.upper, gap.lower + tolerance);
    EXPECT_NEAR(bvh.nearest(gap.place).distance, gap.lower, 1e-12);
    for (int i = 0; i < 2000; ++i) {
      const Triangle& t = cage.triangles[static_cast<std::size_t>(i) % cage.triangles.size()];
      const double u = random.uniform(0, 1);
      const double v = random.uniform(0, 1 - u);
      const Vec3 p =
          (1 - u - v) * cage.positions[t[0]] + u * cage.positions[t[1]] + v * cage.positions[t[2]];
      EXPECT_LE(bvh.nearest(p).distance, gap.upper);
    }
  }
}

TEST(GreatestGap, IsTheSameOnAnyNumberOfThreads) {
  const TriangleBvh model(make_torus(0.2, 48, 24));
  const TriangleMesh cage = scaled(make_icosphere(2), 2);
  const GreatestGap many = greatest_gap(cage, model, 1e-4);
  tbb::task_arena one(1);
  const GreatestGap alone = one.execute([&] { return greatest_gap(cage, model, 1e-4); });
  EXPECT_EQ(alone.lower, many.lower);
  EXPECT_EQ(alone.upper, many.upper);
  EXPECT_EQ(alone.place, many.place);
}

} // namespace
} // namespace cagewright
