#include <cagewright/coordinates/maximum_entropy.h>

#include "coordinates/laws.h"

#include <limits>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return maximum_entropy_coordinates(cage);
}

TEST(MaximumEntropy, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> expected = {.3663248161, .1249764631, .2044154377, .1042832831,
                                        .0715480104, .0371507104, .0577117358, .0335895434};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], expected[c], 6e-11);
  }
  EXPECT_LT((moved(**made, golden_point(), golden_pose()) - Vec3(.3013001, .3805385, .24)).norm(),
            1e-7);
}

TEST(MaximumEntropy, IsBarycentricInATetrahedron) {
  expect_barycentric_in_a_tetrahedron(make, 1e-12);
}

class MaximumEntropyIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
  std::shared_ptr<const Coordinates> made() const {
    Made result = make(cage());
    EXPECT_TRUE(result) << result.error().message;
    return *result;
  }
};

TEST_P(MaximumEntropyIn, SumsToOneReproducesAndIsPositive) {
  const auto coordinates = made();
  std::vector<Vec3> points = points_inside(cage(), 80, 21);
  for (const double distance : {1e-12, 1e-10, 3e-9, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
    const std::vector<Vec3> near = points_inside_near(cage(), distance, 16, 22);
    points.insert(points.end(), near.begin(), near.end());
  }
  for (const Vec3& x : points) {
    // Nearer than 1e-9 to the cage they are those of the nearest place on it.
    const bool is_at_cage = solve(*coordinates, x).report.on_surface != 0;
    expect_partition_and_reproduction(*coordinates, x, unit(), is_at_cage ? 1.5e-9 : 1e-12);
    for (const double w : solve(*coordinates, x).weights) {
      EXPECT_GE(w, 0) << x.transpose();
    }
  }
}

TEST_P(MaximumEntropyIn, InterpolatesOnTheCage) {
  const TriangleMesh mesh = to_triangle_mesh(cage());
  const Made triangles = make(PolygonMesh(mesh));
  ASSERT_TRUE(triangles);
  expect_interpolation(**triangles, mesh, 300);
}

TEST_P(MaximumEntropyIn, FollowsAffineMapsAndSimilarities) {
  const auto coordinates = made();
  const std::vector<Vec3> points = points_inside(cage(), 12, 23);
  expect_affine_maps_follow(*coordinates, points, unit(), 1e-11);
  expect_similarities_follow(*coordinates, points, unit(), 1e-11);
}

TEST_P(MaximumEntropyIn, DoesNotDependOnHowTheCageIsWritten) {
  expect_invariance(make, cage(), points_inside(cage(), 8, 24), 1e-10);
}

TEST_P(MaximumEntropyIn, HasNoWeightsOutside) {
  const auto coordinates = made();
  const Box3 box = bounding_box(cage().positions);
  const TriangleMesh mesh = to_triangle_mesh(cage());
  Random random(25);
  for (int i = 0; i < 80; ++i) {
    const Vec3 offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Vec3 x = box.center() + std::pow(10.0, random.uniform(-1, 4)) * unit() * offset;
    if (std::abs(winding(mesh, x)) < 1e-6) {
      const Solved solved = solve(*coordinates, x);
      EXPECT_EQ(solved.report.outside, 1) << x.transpose();
      EXPECT_EQ(largest(solved.weights), 0);
    }
  }
}

TEST_P(MaximumEntropyIn, IsTheSameForEachInstructionSet) {
  expect_alike_on_all_targets(*made(), points_inside(cage(), 10, 26), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Laws, MaximumEntropyIn, testing::ValuesIn(law_cages()),
                         [](const auto& tested) { return tested.param.name; });

TEST(MaximumEntropy, RefusesOpenCagesAndLeavesPointsThatAreNoneAlone) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made);
  const Solved solved = solve(**made, Vec3(0.5, std::numeric_limits<double>::quiet_NaN(), 0.5));
  EXPECT_EQ(solved.report.undefined, 1);
  EXPECT_EQ(largest(solved.weights), 0);
  PolygonMesh open;
  open.positions = golden_cube().positions;
  open.add_face({0, 2, 3, 1});
  ASSERT_FALSE(make(open));
}

} // namespace
} // namespace cagewright
