#include "improve/nearest_in_half_spaces.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace cagewright {
namespace {

Vec3 random_vector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

TEST(MinimizeInHalfSpaces, BeatsEveryPointInAllOfThem) {
  int with_solution = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Mat3 root;
    for (int k = 0; k < 3; ++k) {
      root.col(k) = random_vector(random);
    }
    const Mat3 hessian = root * root.transpose() + 0.1 * Mat3::Identity();
    const Vec3 gradient = 3 * random_vector(random);
    std::vector<HalfSpace> spaces;
    for (int i = 0; i < 12; ++i) {
      spaces.push_back({random_vector(random).normalized(), random.uniform(-0.1, 0.6)});
    }
    const auto value = [&](const Vec3& x) { return x.dot(hessian * x) / 2 + gradient.dot(x); };
    const auto inside = [&](const Vec3& x, double slack) {
      for (const HalfSpace& s : spaces) {
        if (s.above(x) > slack) {
          return false;
        }
      }
      return true;
    };
    const std::optional<Vec3> best = minimize_in_half_spaces(hessian, gradient, spaces);
    for (int trial = 0; trial < 3000; ++trial) {
      const Vec3 x = (best && trial % 2 == 0) ? Vec3(*best + 0.1 * random_vector(random))
                                              : Vec3(2 * random_vector(random));
      if (inside(x, 0)) {
        ASSERT_TRUE(best) << "seed " << seed;
        EXPECT_LE(value(*best), value(x) + 1e-9) << "seed " << seed;
      }
    }
    if (best) {
      ++with_solution;
      EXPECT_TRUE(inside(*best, 1e-7)) << "seed " << seed;
    }
  }
  EXPECT_GT(with_solution, 20);
}

TEST(MinimizeInHalfSpaces, KnowsWhenThereIsNone) {
  const std::vector<HalfSpace> apart = {{Vec3::UnitX(), -1}, {-Vec3::UnitX(), -1}};
  EXPECT_FALSE(minimize_in_half_spaces(Mat3::Identity(), Vec3::Zero(), apart));
}

TEST(MinimizeInHalfSpaces, TakesPlanesThatCoincide) {
  const std::vector<HalfSpace> same = {
      {Vec3::UnitX(), 1}, {-Vec3::UnitX(), -1}, {Vec3::UnitX(), 1}};
  const std::optional<Vec3> x = minimize_in_half_spaces(Mat3::Identity(), Vec3(0, -2, 0), same);
  ASSERT_TRUE(x);
  EXPECT_LT((*x - Vec3(1, 2, 0)).norm(), 1e-9);
}

} // namespace
} // namespace cagewright
