#include <cagewright/coordinates/positive_mean_value.h>

#include "coordinates/laws.h"
#include <cagewright/coordinates/mean_value.h>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return positive_mean_value_coordinates(cage);
}

TEST(PositiveMeanValue, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> expected = {.3511061796, .1336942667, .2164619986, .0987375551,
                                        .0762620633, .0389374904, .0561697586, .0286306877};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], expected[c], 6e-11);
  }
}

TEST(PositiveMeanValue, IsMeanValueInConvexCages) {
  for (const PolygonMesh& cage : {PolygonMesh(make_icosphere(1)), skewed(make_quad_cube())}) {
    const Made positive = make(cage);
    ASSERT_TRUE(positive);
    const Result<MeanValueSolver> plain = MeanValueSolver::create(cage);
    ASSERT_TRUE(plain);
    for (const Vec3& x : points_inside(cage, 40, 41)) {
      EXPECT_LT(relative_difference(solve(**positive, x).weights, solve(*plain, x).weights), 1e-12)
          << x.transpose();
    }
  }
}

/// A U of which each arm is behind the gap for the other.
TEST(PositiveMeanValue, IsZeroForWhatIsNotSeen) {
  PolygonMesh u;
  const std::vector<std::pair<double, double>> outline = {{0, 0}, {3, 0}, {3, 4}, {2, 4},
                                                          {2, 1}, {1, 1}, {1, 4}, {0, 4}};
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : outline) {
      u.positions.emplace_back(x, y, z);
    }
  }
  std::vector<Index> bottom;
  std::vector<Index> top;
  for (Index i = 0; i < 8; ++i) {
    u.add_face({i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8});
    bottom.insert(bottom.begin(), i);
    top.push_back(i + 8);
  }
  u.add_face(bottom);
  u.add_face(top);
  const Made made = make(u);
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, Vec3(0.5, 3.5, 0.5)).weights;
  for (const std::size_t unseen : {2U, 3U, 10U, 11U}) { // the tip of the other arm
    EXPECT_EQ(weights[unseen], 0);
  }
  EXPECT_GT(weights[7], 0.1);
}

/// The same integral by rays.
TEST(PositiveMeanValue, AgreesWithManyRays) {
  const PolygonMesh cage = make_star();
  const TriangleMesh mesh = to_triangle_mesh(cage);
  const Made made = make(cage);
  ASSERT_TRUE(made);
  for (const Vec3& x : points_inside(cage, 3, 42)) {
    std::vector<double> sums(cage.positions.size(), 0.0);
    constexpr int rays = 60000;
    for (int i = 0; i < rays; ++i) { // along a spiral over the sphere
      const double z = 1 - (2 * i + 1.0) / rays;
      const double turn = i * 2.399963229728653;
      const Vec3 ray(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn),
                     z);
      double nearest = 1e300;
      Vec3 hats = Vec3::Zero();
      const Triangle* hit = nullptr;
      for (const Triangle& t : mesh.triangles) {
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) {
          corners.col(k) = mesh.positions[t[static_cast<std::size_t>(k)]] - x;
        }
        const Vec3 along = corners.partialPivLu().solve(ray); // ray = sum of along_k corner_k
        if (along.minCoeff() >= 0 && 1 / along.sum() < nearest) {
          nearest = 1 / along.sum();
          hats = along / along.sum();
          hit = &t;
        }
      }
      for (std::size_t k = 0; hit != nullptr && k < 3; ++k) {
        sums[(*hit)[k]] += hats[static_cast<Eigen::Index>(k)] / nearest;
      }
    }
    const double all = std::accumulate(sums.begin(), sums.end(), 0.0);
    for (double& sum : sums) {
      sum /= all;
    }
    EXPECT_LT(relative_difference(solve(**made, x).weights, sums), 4e-3) << x.transpose();
  }
}

} // namespace
} // namespace cagewright
