#include "app/edit/cage_pull.h"

#include "app/edit/surface_pick.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/mean_value.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace cagewright::app {
namespace {

/// A sphere as a cage, and points within it with their weights.
class CagePullTest : public testing::Test {
protected:
  void SetUp() override {
    const Result<Weights> found = mean_value_coordinates(cage, points);
    ASSERT_TRUE(found);
    for (std::size_t p = 0; p < points.size(); ++p) {
      weights.push_back(found->row(p));
    }
  }
  [[nodiscard]] Vec3 place(std::size_t p, const std::vector<Vec3>& of_cage) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < of_cage.size(); ++c) {
      sum += weights[p][c] * of_cage[c];
    }
    return sum;
  }

  PolygonMesh cage = PolygonMesh(make_icosphere(2));
  CageGraph graph{cage};
  std::vector<Vec3> points = {{0.7, 0, 0}, {-0.6, 0.1, 0}, {0, 0.5, 0.5}};
  std::vector<std::vector<double>> weights;
};

TEST_F(CagePullTest, BringsEveryPointWhereItIsWanted) {
  const CagePull pull(graph, weights);
  const std::vector<Vec3> targets = {{1.1, 0.2, 0}, points[1], {0, 0.4, 0.9}};
  const std::vector<Vec3> moved = pull.pulled(cage.positions, targets);
  for (std::size_t p = 0; p < targets.size(); ++p) {
    EXPECT_LT((place(p, moved) - targets[p]).norm(), 1e-9) << p;
  }
}

TEST_F(CagePullTest, LeavesTheCageWhereNothingIsAskedFor) {
  const CagePull pull(graph, weights);
  const std::vector<Vec3> moved = pull.pulled(cage.positions, points);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    EXPECT_LT((moved[v] - cage.positions[v]).norm(), 1e-9);
  }
}

TEST_F(CagePullTest, MovesWhatIsNearMoreThanWhatIsFar) {
  const std::array held = {weights[0], weights[1]};
  const CagePull pull(graph, held);
  const std::vector<Vec3> moved =
      pull.pulled(cage.positions, std::vector<Vec3>{points[0] + Vec3(0.3, 0, 0), points[1]});
  double near = 0;
  double far = 0;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const double by = (moved[v] - cage.positions[v]).norm();
    (cage.positions[v].x() > 0.5 ? near : far) =
        std::max(cage.positions[v].x() > 0.5 ? near : far, by);
    EXPECT_TRUE(moved[v].allFinite());
  }
  EXPECT_GT(near, 1.5 * far);
}

TEST_F(CagePullTest, TakesTheLeastOfAllMoves) {
  // Any other move that meets the targets costs more: add what no point feels.
  const std::array one = {weights[2]};
  const CagePull pull(graph, one);
  const std::vector<Vec3> target = {points[2] + Vec3(0, 0.2, 0.1)};
  const std::vector<Vec3> moved = pull.pulled(cage.positions, target);
  const auto cost = [&](const std::vector<Vec3>& at) {
    double sum = 0;
    for (std::size_t v = 0; v < at.size(); ++v) {
      sum += (at[v] - cage.positions[v]).squaredNorm();
    }
    for (const auto& [a, b] : graph.edges()) {
      sum += CagePull::usual_stiffness *
             ((at[a] - cage.positions[a]) - (at[b] - cage.positions[b])).squaredNorm();
    }
    return sum;
  };
  for (std::size_t v = 0; v + 1 < moved.size(); v += 7) {
    std::vector<Vec3> other = moved;
    other[v] += Vec3(0.01, 0, 0) * weights[2][v + 1];
    other[v + 1] -= Vec3(0.01, 0, 0) * weights[2][v];
    ASSERT_LT((place(2, other) - target[0]).norm(), 1e-9);
    EXPECT_GT(cost(other), cost(moved));
  }
}

TEST_F(CagePullTest, MeetsContradictingTargetsHalfWay) {
  const std::array twice = {weights[0], weights[0]};
  const CagePull pull(graph, twice);
  const std::vector<Vec3> moved = pull.pulled(
      cage.positions, std::vector<Vec3>{points[0] + Vec3(0, 0.2, 0), points[0] - Vec3(0, 0.4, 0)});
  EXPECT_LT((place(0, moved) - (points[0] - Vec3(0, 0.1, 0))).norm(), 1e-9);
}

TEST(SurfacePick, FindsTheNearestOfAllTriangles) {
  const TriangleMesh ball = make_icosphere(5); // more than a block
  const Ray sight{{0.1, 0.2, 5}, {0, 0, -1}};
  const auto found = first_surface_point(ball, sight);
  ASSERT_TRUE(found);
  const Triangle& t = ball.triangles[found->triangle];
  Vec3 place = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    place += found->shares[k] * ball.positions[t[k]];
  }
  EXPECT_LT((place - sight.at(found->distance)).norm(), 1e-12);
  EXPECT_NEAR(place.z(), std::sqrt(1 - 0.05), 2e-3) << "the near side";
  EXPECT_FALSE(first_surface_point(ball, Ray{{3, 0, 5}, {0, 0, -1}}));
  EXPECT_FALSE(first_surface_point(ball, Ray{{0, 0, 5}, {0, 0, 1}})) << "behind the eye";
}

} // namespace
} // namespace cagewright::app
