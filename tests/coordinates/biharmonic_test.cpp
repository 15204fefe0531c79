#include <cagewright/coordinates/biharmonic.h>

#include "coordinates/laws.h"

#include <limits>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return biharmonic_coordinates(cage);
}

TEST(Biharmonic, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> alpha = {.36576, .15883, .24367, .10053,
                                     .09780, .00978, .05060, -.02698};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], alpha[c], 5e-4);
  }
  EXPECT_LT((moved(**made, golden_point(), golden_pose()) - Vec3(.3096, .3683, .2487)).norm(),
            5e-4);
}

class BiharmonicIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
};

TEST_P(BiharmonicIn, KeepsTheLaws) {
  const Made made = make(cage());
  ASSERT_TRUE(made) << made.error().message;
  std::vector<Vec3> points = points_inside(cage(), 30, 91);
  for (const double distance : {1e-12, 1e-8, 1e-4, 1e-2}) {
    const std::vector<Vec3> near = points_inside_near(cage(), distance, 10, 92);
    points.insert(points.end(), near.begin(), near.end());
  }
  for (const Vec3& x : points) {
    expect_partition_and_reproduction(**made, x, unit(), 1e-12);
  }
  expect_similarities_follow(**made, points_inside(cage(), 8, 93), unit(), 1e-10);
  EXPECT_EQ(solve(**made, Vec3(9, 9, 9)).report.outside, 1);
}

/// The larger the closeness, the nearer to the cage comes what lies on it.
TEST_P(BiharmonicIn, FollowsTheCageMoreCloselyThanGreen) {
  std::vector<Vec3> pose = cage().positions;
  Random random(94);
  for (Vec3& p : pose) {
    p += 0.05 * unit() * random_direction(random);
  }
  const TriangleMesh mesh = to_triangle_mesh(cage());
  std::vector<double> errors;
  for (const double closeness : {0.01, 1.0, 100.0}) {
    const Made made = biharmonic_coordinates(PolygonMesh(mesh), {.closeness = closeness});
    ASSERT_TRUE(made);
    double sum = 0;
    for (const OnCage& on : points_on(mesh, 60, 95)) {
      sum += (moved(**made, on.x, pose) - reproduced(on.weights, pose)).squaredNorm();
    }
    errors.push_back(sum);
  }
  EXPECT_LT(errors[1], errors[0]);
  EXPECT_LT(errors[2], 1.1 * errors[1]); // all in all: these are some places of many
}

TEST_P(BiharmonicIn, HardlyDependsOnHowTheCageIsWritten) {
  expect_invariance(make, cage(), points_inside(cage(), 4, 96), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Laws, BiharmonicIn, testing::ValuesIn(law_cages()),
                         [](const auto& tested) { return tested.param.name; });

} // namespace
} // namespace cagewright
