#include <cagewright/coordinates/harmonic.h>

#include "coordinates/laws.h"
#include "coordinates/normal_equations.h"

#include <Eigen/QR>
#include <tbb/task_arena.h>

#include <limits>
#include <numeric>

namespace cagewright {
namespace {

using namespace cagewright::test;

/// Quick: the laws hold however coarse it is.
Made make(const PolygonMesh& cage) {
  return harmonic_coordinates(cage, {.accuracy = 0.1, .unknowns = 1000});
}

TEST(Harmonic, HasTheGoldenValuesToWithinItsAccuracy) {
  const std::vector<double> expected = {.34421669, .13777374, .21731175, .10069789,
                                        .08078113, .03722849, .05769049, .02429991};
  for (const double accuracy : {2e-3, 5e-4}) {
    const Made made = harmonic_coordinates(golden_cube(), {.accuracy = accuracy});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_LE((*made)->error_estimate(), accuracy);
    EXPECT_GT((*made)->error_estimate(), 0);
    EXPECT_LE((*made)->error_bound(), 4 * accuracy); // at the edges of the cage
    const std::vector<double> weights = solve(**made, golden_point()).weights;
    for (std::size_t c = 0; c < 8; ++c) {
      EXPECT_NEAR(weights[c], expected[c], (*made)->error_bound());
      EXPECT_NEAR(weights[c], expected[c], 1e-4); // inside they are far better than on the cage
    }
    EXPECT_LT((moved(**made, golden_point(), golden_pose()) - Vec3(.305805, .373485, .24)).norm(),
              1e-4);
  }
}

class HarmonicIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
};

TEST_P(HarmonicIn, KeepsTheLaws) {
  const Made made = make(cage());
  ASSERT_TRUE(made) << made.error().message;
  const double bound = (*made)->error_bound();
  EXPECT_LT(bound, 0.3);
  EXPECT_LE((*made)->error_estimate(), 0.2);
  std::vector<Vec3> points = points_inside(cage(), 40, 81);
  for (const double distance : {1e-12, 1e-8, 1e-4, 1e-2}) {
    const std::vector<Vec3> near = points_inside_near(cage(), distance, 10, 82);
    points.insert(points.end(), near.begin(), near.end());
  }
  for (const Vec3& x : points) {
    expect_partition_and_reproduction(**made, x, unit(), 1e-12);
    const std::vector<double> weights = solve(**made, x).weights;
    EXPECT_GE(*std::ranges::min_element(weights), 0) << x.transpose();
  }
  expect_affine_maps_follow(**made, points, unit(), 1e-11);
  expect_similarities_follow(**made, points_inside(cage(), 8, 83), unit(), 1e-11);
  for (int i = 0; i < 2; ++i) {
    const Vec3 outside = 3 * unit() * Vec3(1, i, 0.5);
    EXPECT_EQ(solve(**made, outside).report.outside, 1);
    EXPECT_EQ(largest(solve(**made, outside).weights), 0);
  }
}

TEST_P(HarmonicIn, InterpolatesToWithinItsBound) {
  const TriangleMesh mesh = to_triangle_mesh(cage());
  const Made made = make(PolygonMesh(mesh));
  ASSERT_TRUE(made);
  const double bound = (*made)->error_bound();
  for (const OnCage& on : points_on(mesh, 90, 84)) {
    const Solved here = solve(**made, on.x);
    EXPECT_EQ(here.report.on_surface, 1);
    for (std::size_t c = 0; c < on.weights.size(); ++c) {
      EXPECT_NEAR(here.weights[c], on.weights[c], 1.5 * bound + 1e-13) << on.x.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, HarmonicIn, testing::ValuesIn(law_cages()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Harmonic, IsBarycentricInATetrahedron) {
  expect_barycentric_in_a_tetrahedron(make, 1e-12);
}

TEST(Harmonic, HardlyDependsOnHowTheCageIsWritten) {
  // Strips are cut along a diagonal, which a mirror turns.
  expect_invariance(make, make_star(), points_inside(make_star(), 6, 85), 2e-4);
}

TEST(Harmonic, DoesNotDependOnTheNumberOfThreads) {
  const auto on = [](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([] { return solve(**make(golden_cube()), golden_point()).weights; });
  };
  EXPECT_EQ(on(1), on(3));
}

TEST(Harmonic, StopsWhenAsked) {
  StopFlag stop;
  stop.request_stop();
  const Made made = harmonic_coordinates(golden_cube(), {}, Progress(stop));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

TEST(PositiveSystem, SolveLeastSquares) {
  Random random(86);
  constexpr Eigen::Index rows = 150;
  constexpr Eigen::Index unknowns = 53;
  constexpr Eigen::Index sides = 19;
  Eigen::MatrixXd a(rows, unknowns);
  Eigen::MatrixXd b(rows, sides);
  for (Eigen::Index r = 0; r < rows; ++r) {
    for (Eigen::Index u = 0; u < unknowns; ++u) {
      a(r, u) = random.uniform(-1, 1);
    }
    for (Eigen::Index s = 0; s < sides; ++s) {
      b(r, s) = random.uniform(-1, 1);
    }
  }
  PositiveSystem equations(unknowns, sides);
  for (Eigen::Index first = 0; first < rows; first += 50) {
    StripMatrix some(50, unknowns);
    StripMatrix some_sides(50, sides);
    for (std::size_t r = 0; r < 50; ++r) {
      for (std::size_t u = 0; u < unknowns; ++u) {
        some.at(r, u) = a(first + static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(u));
      }
      for (std::size_t s = 0; s < sides; ++s) {
        some_sides.at(r, s) = b(first + static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(s));
      }
    }
    equations.add(some, some_sides);
  }
  const Result<StripMatrix> solved = equations.solve({});
  ASSERT_TRUE(solved);
  const Eigen::MatrixXd expected = a.colPivHouseholderQr().solve(b);
  for (std::size_t u = 0; u < unknowns; ++u) {
    for (std::size_t s = 0; s < sides; ++s) {
      EXPECT_NEAR(solved->at(u, s),
                  expected(static_cast<Eigen::Index>(u), static_cast<Eigen::Index>(s)), 1e-11);
    }
  }
}

TEST(Harmonic, TellsAnErrorWhereNothingCoarserIsThere) {
  const PolygonMesh cage = make_star();
  const std::size_t triangles = to_triangle_mesh(cage).triangles.size();
  const Made made = harmonic_coordinates(cage, {.unknowns = 3 * triangles}); // three a triangle
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_GT((*made)->error_estimate(), 1e-3);
  EXPECT_EQ((*made)->error_estimate(), (*made)->error_bound());
}

/// At its tip they err by more than half of a weight, elsewhere they do not.
TEST(Harmonic, ComesOutRoundADentLikeANeedle) {
  constexpr double wide = 0.05;
  PolygonMesh cage;
  cage.positions = {{0, 0, 0},
                    {1, 0, 0},
                    {1, 1, 0},
                    {0, 1, 0},
                    {0, 0, 1},
                    {1, 0, 1},
                    {1, 1, 1},
                    {0, 1, 1},
                    {.5 - wide, .5 - wide, 1},
                    {.5 + wide, .5 - wide, 1},
                    {.5 + wide, .5 + wide, 1},
                    {.5 - wide, .5 + wide, 1},
                    {.5, .5, .2}};
  cage.add_face({0, 3, 2, 1});
  for (Index i = 0; i < 4; ++i) {
    const Index next = (i + 1) % 4;
    cage.add_face({i, next, next + 4, i + 4});
    cage.add_face({i + 4, next + 4, next + 8, i + 8});
    cage.add_face({i + 8, next + 8, 12});
  }
  const Made made = harmonic_coordinates(cage, {.accuracy = 0.05});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_GT((*made)->error_bound(), 0.5);
  EXPECT_LT((*made)->error_estimate(), 0.1);
  const std::vector<double> weights = solve(**made, Vec3(0.2, 0.2, 0.4)).weights;
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-12);
}

} // namespace
} // namespace cagewright
