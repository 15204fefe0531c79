#include <cagewright/coordinates/somigliana.h>

#include "coordinates/laws.h"
#include "coordinates/surface.h"
#include <cagewright/coordinates/green.h>

#include <boost/math/quadrature/gauss.hpp>

#include <limits>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return somigliana_coordinates(cage);
}

Mat3 matrix_of(const std::vector<double>& weights, std::size_t vertex) {
  Mat3 phi;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      phi(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          weights[9 * vertex + 3 * a + b];
    }
  }
  return phi;
}

/// Of each vertex of the cage, with its share of the middles of quads.
std::vector<Mat3> matrices_of(const std::vector<double>& weights, const PolygonMesh& cage) {
  std::vector<Mat3> all;
  for (std::size_t v = 0; v < cage.positions.size(); ++v) {
    all.push_back(matrix_of(weights, v));
  }
  const TriangulatedCage cut = triangulated(cage, QuadTreatment::center);
  for (std::size_t q = 0; q < cut.quads.size(); ++q) {
    for (const Index corner : cut.quads[q]) {
      all[corner] += matrix_of(weights, cage.positions.size() + q) / 4;
    }
  }
  return all;
}

Vec3 moved_divided(const Coordinates& coordinates, const Vec3& x, std::span<const Vec3> pose) {
  const Vec3 plain = moved(coordinates, x, pose);
  const auto divisor = coordinates.rule()->divisor(pose);
  if (!divisor) {
    return plain;
  }
  const std::vector<double> weights = solve(coordinates, x).weights;
  Mat3 matrix = Mat3::Identity();
  for (Eigen::Index a = 0; a < 3; ++a) {
    matrix.col(a) += reproduced(weights, divisor->moves[static_cast<std::size_t>(a)]);
  }
  return divisor->center + matrix.partialPivLu().solve(plain - divisor->center);
}

TEST(Somigliana, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  Mat3 phi;
  phi << .2763803752, .0303988789, -.0038969939, .0211118541, .2867979865, .0006128485, .0079504060,
      .0229550722, .2654976154;
  EXPECT_LT((matrices_of(weights, golden_cube())[0] - phi).cwiseAbs().maxCoeff(), 6e-11);
  Vec3 sum = Vec3::Zero(); // of k over the first quad's triangles
  for (std::size_t t = 0; t < 4; ++t) {
    for (std::size_t a = 0; a < 3; ++a) {
      sum[static_cast<Eigen::Index>(a)] += std::sqrt(3) * weights[126 + 3 * t + a];
    }
  }
  EXPECT_LT((sum - Vec3(.0054721611, .0025348869, -.1436013630)).norm(), 1e-9);
}

TEST(Somigliana, PosesTheGoldenCube) {
  struct Case {
    double bulge, local;
    Vec3 expected;
  };
  for (const Case& one : {Case{0, 0, Vec3(.3028186, .3628396, .2736680)},
                          Case{1, 0, Vec3(.3035061, .3632753, .2728825)},
                          Case{0, .5, Vec3(.2983775, .3721129, .2760322)},
                          Case{1, .5, Vec3(.2990978, .3724633, .2753609)}}) {
    const Made made =
        somigliana_coordinates(golden_cube(), {.bulge = one.bulge, .local = one.local});
    ASSERT_TRUE(made);
    EXPECT_LT((moved_divided(**made, golden_point(), golden_pose()) - one.expected).norm(), 2e-7)
        << one.bulge << ' ' << one.local << ": "
        << moved_divided(**made, golden_point(), golden_pose()).transpose();
  }
}

class SomiglianaIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
  std::vector<Vec3> points() const {
    std::vector<Vec3> all = points_inside(cage(), 40, 71);
    for (const double distance : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
      const std::vector<Vec3> near = points_inside_near(cage(), distance, 16, 72);
      all.insert(all.end(), near.begin(), near.end());
    }
    for (const OnCage& on : points_on(triangulated(cage(), QuadTreatment::center).mesh, 24, 73)) {
      all.push_back(on.x);
    }
    return all;
  }
};

TEST_P(SomiglianaIn, SumsToTheIdentityAndReproducesRigidMotionsAndScalings) {
  for (const double ratio : {0.0, 0.3, 0.49}) {
    const Made made = somigliana_coordinates(cage(), {.poisson_ratio = ratio});
    ASSERT_TRUE(made);
    const std::vector<Vec3> from = (*made)->rule()->reproduced_from();
    for (const Vec3& x : points()) {
      const Solved solved = solve(**made, x);
      EXPECT_EQ(solved.report.outside | solved.report.undefined, 0);
      const double tolerance = 1e-12 * std::max(1.0, largest(solved.weights));
      Mat3 sum = Mat3::Zero();
      Vec3 turned = Vec3::Zero();
      const Vec3 axis(0.3, -0.7, 0.2);
      const std::vector<Mat3> matrices = matrices_of(solved.weights, cage());
      for (std::size_t c = 0; c < cage().positions.size(); ++c) {
        sum += matrices[c];
        turned += matrices[c] * axis.cross(cage().positions[c]);
      }
      EXPECT_LT((sum - Mat3::Identity()).norm(), tolerance) << ratio << ": " << x.transpose();
      EXPECT_LT((turned - axis.cross(x)).norm(), 5 * tolerance * unit()) << x.transpose();
      EXPECT_LT((reproduced(solved.weights, from) - x).norm(), 30 * tolerance * unit())
          << ratio << ": " << x.transpose();
    }
  }
}

TEST_P(SomiglianaIn, HasTheTracesOfGreen) {
  const Made made = make(cage());
  const Made green = green_coordinates(cage());
  ASSERT_TRUE(made && green);
  for (const Vec3& x : points()) {
    const std::vector<Mat3> matrices = matrices_of(solve(**made, x).weights, cage());
    const std::vector<double> phi = solve(**green, x).weights;
    for (std::size_t c = 0; c < cage().positions.size(); ++c) {
      EXPECT_NEAR(matrices[c].trace() / 3, phi[c], 2e-12) << x.transpose();
    }
  }
}

TEST_P(SomiglianaIn, IsContinuousUpToTheCageAndThroughIt) {
  const Made made = somigliana_coordinates(cage(), {.outside = OutsideTreatment::continuation});
  ASSERT_TRUE(made);
  const TriangleMesh mesh = triangulated(cage(), QuadTreatment::center).mesh;
  Random random(74);
  std::size_t i = 0;
  for (const OnCage& on : points_on(mesh, 45, 75)) {
    const bool in_face = i++ % 3 == 0;
    const std::vector<double> here = solve(**made, on.x).weights;
    for (const double distance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const Vec3 near = on.x + distance * unit() * random_direction(random);
      if (in_face || is_inside(mesh, near)) {
        EXPECT_LT(relative_difference(solve(**made, near).weights, here),
                  200 * distance * std::log(1 / distance))
            << distance << ": " << on.x.transpose();
      }
    }
  }
}

TEST_P(SomiglianaIn, FollowsSimilaritiesWhateverItsControls) {
  const std::vector<Vec3> inside = points_inside(cage(), 10, 76);
  for (const auto& [bulge, local] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, 1.0}, {2.0, 0.4}}) {
    const Made made = somigliana_coordinates(cage(), {.bulge = bulge, .local = local});
    ASSERT_TRUE(made);
    for (const double scale : {0.4, 3.0}) {
      const test::Similarity map = some_similarity(scale);
      std::vector<Vec3> pose;
      for (const Vec3& c : cage().positions) {
        pose.push_back(map(c));
      }
      for (const Vec3& x : inside) {
        EXPECT_LT((moved_divided(**made, x, pose) - map(x)).norm(), 1e-11 * scale * unit())
            << bulge << ' ' << local << ": " << x.transpose();
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, SomiglianaIn, testing::ValuesIn(law_cages()),
                         [](const auto& tested) { return tested.param.name; });

/// Gauss's nodes on [0, 1] with their weights.
std::vector<std::pair<double, double>> gauss_nodes() {
  using Rule = boost::math::quadrature::gauss<double, 60>;
  std::vector<std::pair<double, double>> nodes;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      nodes.emplace_back(0.5 + side * Rule::abscissa()[i] / 2, Rule::weights()[i] / 2);
    }
  }
  return nodes;
}

/// Kelvin's solution by brute force.
TEST(Somigliana, IsTheIntegralThatDefinesIt) {
  const TriangleMesh cage = make_cube();
  const double nu = 0.3;
  const double kappa = 1 / (8 * std::numbers::pi * (1 - nu));
  const Vec3 x(0.2, -0.3, 0.1);
  std::vector<Mat3> phi(8, Mat3::Zero());
  const auto nodes = gauss_nodes();
  for (const Triangle& t : cage.triangles) {
    const Vec3 a = cage.positions[t[0]];
    const Vec3 ab = cage.positions[t[1]] - a;
    const Vec3 bc = cage.positions[t[2]] - cage.positions[t[1]];
    const Vec3 area = ab.cross(bc);
    const Vec3 n = area.normalized();
    for (const auto& [u, weight_u] : nodes) {
      for (const auto& [v, weight_v] : nodes) {
        const Vec3 r = a + u * ab + u * v * bc - x;
        const double size = r.norm();
        const Vec3 e = r / size;
        const Mat3 traction =
            -kappa / (size * size) *
            (e.dot(n) * ((1 - 2 * nu) * Mat3::Identity() + 3 * e * e.transpose()) -
             (1 - 2 * nu) * (e * n.transpose() - n * e.transpose()));
        const std::array<double, 3> hats = {1 - u, u * (1 - v), u * v};
        for (std::size_t k = 0; k < 3; ++k) {
          phi[t[k]] -= weight_u * weight_v * u * area.norm() * hats[k] * traction;
        }
      }
    }
  }
  const Made made = make(PolygonMesh(cage));
  ASSERT_TRUE(made);
  const std::vector<double> weights = solve(**made, x).weights;
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_LT((matrix_of(weights, c) - phi[c]).norm(), 1e-12);
  }
}

TEST(Somigliana, IsTheSameForEachInstructionSet) {
  const Made made = make(make_star());
  ASSERT_TRUE(made);
  expect_alike_on_all_targets(**made, points_inside(make_star(), 20, 77), 1e-13);
}

TEST(Somigliana, RefusesWhatIsNoBody) {
  EXPECT_FALSE(somigliana_coordinates(golden_cube(), {.poisson_ratio = 0.5}));
  EXPECT_FALSE(somigliana_coordinates(golden_cube(), {.local = 1.5}));
  const Made made = make(golden_cube());
  ASSERT_TRUE(made);
  const Solved solved = solve(**made, Vec3(0.5, std::numeric_limits<double>::quiet_NaN(), 0.5));
  EXPECT_EQ(solved.report.undefined, 1);
  EXPECT_EQ(largest(solved.weights), 0);
}

/// Half turns of faces have no Cayley transform.
TEST(Somigliana, SurvivesFacesThatTurnRound) {
  const Made made = somigliana_coordinates(PolygonMesh(make_cube()), {.local = 1});
  ASSERT_TRUE(made);
  std::vector<Vec3> pose = make_cube().positions;
  for (Vec3& p : pose) {
    if (p.z() > 0) {
      p = Vec3(-p.x(), -p.y(), p.z());
    }
  }
  EXPECT_TRUE(moved_divided(**made, Vec3(0.1, 0.2, 0.3), pose).allFinite());
  pose[7] = pose[6]; // and one that collapses
  EXPECT_TRUE(moved_divided(**made, Vec3(0.1, 0.2, 0.3), pose).allFinite());
}

} // namespace
} // namespace cagewright
