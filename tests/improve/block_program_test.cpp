#include "improve/block_program.h"

#include "core/random.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

constexpr BlockProgramOptions exact = {.slack = 1e-9, .accuracy = 1e-8};

// Points on a chain, each tied to its place and to the next point, in random directions.
BlockQuadratic random_chain(Random& random, Index count) {
  BlockQuadratic quadratic(count);
  const auto direction = [&] {
    return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (Index v = 0; v < count; ++v) {
    quadratic.gradient[v] = direction();
    quadratic.terms.push_back({v, v, Mat3::Identity()});
    if (v > 0) {
      const Vec3 d = direction();
      quadratic.terms.push_back({v, v, d * d.transpose()});
      quadratic.terms.push_back({v - 1, v - 1, d * d.transpose()});
      quadratic.terms.push_back({v, v - 1, -d * d.transpose()});
    }
  }
  return quadratic;
}

// H x + g
std::vector<Vec3> slope(const BlockQuadratic& quadratic, const std::vector<Vec3>& x) {
  std::vector<Vec3> result = quadratic.gradient;
  for (const BlockQuadratic::Term& t : quadratic.terms) {
    result[t.row] += t.block * x[t.column];
    if (t.row != t.column) {
      result[t.column] += t.block.transpose() * x[t.row];
    }
  }
  return result;
}

TEST(BlockProgram, WithoutConstraintsTheSlopeVanishes) {
  Random random(1);
  const BlockQuadratic quadratic = random_chain(random, 20);
  const std::vector<Vec3> x = minimize(quadratic, {}, exact);
  for (const Vec3& g : slope(quadratic, x)) {
    EXPECT_LT(g.norm(), 1e-6);
  }
}

TEST(BlockProgram, TheSlopeIsMadeOfActiveConstraints) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const BlockQuadratic quadratic = random_chain(random, 12);
    std::vector<BlockConstraint> constraints;
    for (Index v = 0; v + 2 < 12; ++v) {
      const Vec3 d =
          Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
      constraints.push_back({{v, v + 1, v + 2}, {0.5, 0.3, 0.2}, d, random.uniform(-0.3, 0.1)});
    }
    const std::vector<Vec3> x = minimize(quadratic, constraints, exact);
    double best = 0;
    for (Index v = 0; v < 12; ++v) {
      best += quadratic.gradient[v].dot(x[v]);
    }
    const std::vector<Vec3> g = slope(quadratic, x);
    // Every way that the constraints allow leads up.
    for (const BlockConstraint& c : constraints) {
      const auto value = [&](const std::vector<Vec3>& y) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
          sum += c.weight[i] * c.direction.dot(y[c.vertex[i]]);
        }
        return sum;
      };
      EXPECT_GE(value(x), c.bound - 1e-5);
    }
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<Vec3> y = x;
      for (Vec3& p : y) {
        p += 0.01 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      }
      bool allowed = true;
      for (const BlockConstraint& c : constraints) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
          sum += c.weight[i] * c.direction.dot(y[c.vertex[i]]);
        }
        allowed = allowed && sum >= c.bound;
      }
      double rise = 0;
      for (Index v = 0; v < 12; ++v) {
        rise += g[v].dot(y[v] - x[v]);
      }
      EXPECT_TRUE(!allowed || rise > -1e-4) << "seed " << seed;
    }
  }
}

TEST(BlockProgram, ComesAsNearAsItCanToConstraintsThatContradict) {
  BlockQuadratic quadratic(1);
  quadratic.terms.push_back({0, 0, Mat3::Identity()});
  const std::vector<BlockConstraint> constraints = {{{0, 0, 0}, {1, 0, 0}, Vec3::UnitX(), 1},
                                                    {{0, 0, 0}, {1, 0, 0}, -Vec3::UnitX(), 1}};
  const std::vector<Vec3> x = minimize(quadratic, constraints, {.slack = 1e-6, .accuracy = 1e-8});
  EXPECT_NEAR(x[0].x(), 0, 1e-3); // 1 <= x <= -1
}

// What a step of the relaxation is corrected by: nothing pulls, and faces that have sunk into a
// model ask for room at many places, against each other.
TEST(BlockProgram, FindsRoomForManyConstraintsThatAskForMuchMoreThanTheSlack) {
  constexpr Index count = 250;
  constexpr double slack = 1e-7;
  Random random(1);
  BlockQuadratic quadratic(count);
  for (Index v = 0; v < count; ++v) {
    quadratic.terms.push_back({v, v, 50 * Mat3::Identity()});
  }
  std::vector<BlockConstraint> constraints;
  for (Index v = 0; v + 2 < count; ++v) {
    const Vec3 normal =
        Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const bool sunk = v % 2 == 0;
    for (int k = 0; k < 16; ++k) {
      const double a = random.uniform(0, 1);
      const double b = random.uniform(0, 1 - a);
      const double bound = sunk ? random.uniform(-1e-4, 2.6e-3) : random.uniform(-5e-3, -1e-5);
      constraints.push_back({{v, v + 1, v + 2}, {a, b, 1 - a - b}, normal, bound});
    }
    for (const double side : {1.0, -1.0}) {
      for (int k = 0; k < 3; ++k) {
        constraints.push_back({{v, v, v}, {1, 0, 0}, side * Vec3::Unit(k), -2.5e-3});
      }
    }
  }
  const std::vector<Vec3> x = minimize(quadratic, constraints, {.slack = slack});
  double missed = 0;
  for (const BlockConstraint& c : constraints) {
    double reached = 0;
    for (int i = 0; i < 3; ++i) {
      reached += c.weight[i] * c.direction.dot(x[c.vertex[i]]);
    }
    missed = std::max(missed, c.bound - reached);
  }
  EXPECT_LT(missed, 2e-3);
}

} // namespace
} // namespace cagewright
