#include <cagewright/coordinates/green.h>

#include "coordinates/laws.h"

#include <hwy/targets.h>

#include <limits>

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return green_coordinates(cage);
}

/// The definition's closed form in 113 bits, for points off the cage.
std::vector<double> reference(TriangleView cage, const Vec3& x) {
  std::vector<Quad> phi(cage.positions.size());
  std::vector<Quad> psi;
  const Quad unit = diagonal(cage.positions);
  const Quad per_angle = 1 / (4 * boost::math::constants::pi<Quad>());
  for (const Triangle& t : cage.triangles) {
    const std::array<QuadVec3, 3> a = {minus(cage.positions[t[0]], x),
                                       minus(cage.positions[t[1]], x),
                                       minus(cage.positions[t[2]], x)};
    const auto between = [&](std::size_t i, std::size_t j) -> QuadVec3 {
      return {a[j][0] - a[i][0], a[j][1] - a[i][1], a[j][2] - a[i][2]};
    };
    QuadVec3 normal = cross(between(0, 1), between(0, 2));
    const Quad twice_area = sqrt(dot(normal, normal));
    for (Quad& n : normal) {
      n /= twice_area;
    }
    std::array<Quad, 3> d;
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = sqrt(dot(a[i], a[i]));
    }
    const Quad h = dot(normal, a[0]);
    const Quad omega =
        2 * atan2(twice_area * h, d[0] * d[1] * d[2] + dot(a[0], a[1]) * d[2] +
                                      dot(a[1], a[2]) * d[0] + dot(a[2], a[0]) * d[1]);
    std::array<QuadVec3, 3> nu;
    std::array<Quad, 3> rho;
    std::array<Quad, 3> length;
    QuadVec3 q = {0, 0, 0};
    Quad potential = -h * omega;
    for (std::size_t e = 0; e < 3; ++e) {
      const QuadVec3 edge = between(e, (e + 1) % 3);
      length[e] = sqrt(dot(edge, edge));
      nu[e] = cross(edge, normal);
      for (Quad& n : nu[e]) {
        n /= length[e];
      }
      rho[e] = dot(nu[e], a[e]);
      const Quad sum = d[e] + d[(e + 1) % 3];
      const Quad log_e = log((sum + length[e]) / (sum - length[e]));
      for (std::size_t k = 0; k < 3; ++k) {
        q[k] += log_e * nu[e][k];
      }
      potential += rho[e] * log_e;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t e = (i + 1) % 3;
      const Quad lambda = rho[e] * length[e] / twice_area;
      const Quad slope = -dot(nu[e], q) * length[e] / twice_area;
      phi[t[i]] += per_angle * (lambda * omega - h * slope);
    }
    psi.push_back(per_angle * potential / unit);
  }
  std::vector<double> all;
  for (const Quad& w : phi) {
    all.push_back(static_cast<double>(w));
  }
  for (const Quad& w : psi) {
    all.push_back(static_cast<double>(w));
  }
  return all;
}

TEST(Green, HasTheGoldenValues) {
  const Made green = make(golden_cube());
  ASSERT_TRUE(green) << green.error().message;
  const std::vector<double> weights = solve(**green, golden_point()).weights;
  const std::vector<double> phi = {.2762253257, .1318781831, .1865125679, .1038912006,
                                   .0978758241, .0664930579, .0800469062, .0570769345};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], phi[c], 6e-11);
  }
  const double unit = std::sqrt(3);
  const std::vector<double> psi = {.0641969750, .0381754609, .0342284965, .0520038360};
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_NEAR(weights[8 + t] * unit, psi[t], 6e-11);
  }
  const Vec3 x = moved(**green, golden_point(), golden_pose());
  EXPECT_LT((x - Vec3(.3035076, .3654987, .2222916)).norm(), 1e-7);
}

class GreenIn : public testing::TestWithParam<LawCage> {
protected:
  const PolygonMesh& cage() const { return GetParam().mesh; }
  double unit() const { return diagonal(cage().positions); }
  std::shared_ptr<const Coordinates>
  green(OutsideTreatment outside = OutsideTreatment::error) const {
    Made made = green_coordinates(cage(), {.outside = outside});
    EXPECT_TRUE(made) << made.error().message;
    return *made;
  }
};

TEST_P(GreenIn, AgreesWithTheClosedFormIn113Bits) {
  Made made = green_coordinates(cage(), {.quads = QuadTreatment::diagonal});
  ASSERT_TRUE(made);
  const TriangleMesh mesh = to_triangle_mesh(cage());
  for (const double distance :
       {1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 3e-4, 6e-4, 1e-3, 1e-2, 1e-1}) {
    for (const Vec3& x : points_inside_near(cage(), distance, 8, 5)) {
      const std::vector<double> found = solve(**made, x).weights;
      // At 1e-12 the coordinates that are rounded in the cage's frame are no longer the same point.
      const double lost = 4e-16 / distance;
      EXPECT_LT(relative_difference(found, reference(mesh, x)), 1e-12 + 1e-2 * lost)
          << distance << ": " << x.transpose();
    }
  }
  for (const Vec3& x : points_inside(cage(), 20, 6)) {
    EXPECT_LT(relative_difference(solve(**made, x).weights, reference(mesh, x)), 1e-13);
  }
}

TEST_P(GreenIn, SumsToOneAndReproducesItsPoints) {
  const auto coordinates = green();
  for (const double distance : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 1e-1}) {
    for (const Vec3& x : points_inside_near(cage(), distance, 24, 7)) {
      expect_partition_and_reproduction(*coordinates, x, unit(), 1e-12);
    }
  }
  for (const Vec3& x : points_inside(cage(), 60, 8)) {
    expect_partition_and_reproduction(*coordinates, x, unit(), 1e-13);
  }
}

TEST_P(GreenIn, IsContinuedOnTheCage) {
  const auto coordinates = green();
  const TriangleMesh mesh = to_triangle_mesh(cage());
  Random random(9);
  for (int i = 0; i < 60; ++i) {
    const Site site = std::array{Site::face, Site::edge, Site::vertex}[random.below(3)];
    const Vec3 on = point_near(mesh, site, 0, random);
    const Solved here = solve(*coordinates, on);
    EXPECT_NE(here.report.on_surface, 0) << on.transpose();
    expect_partition_and_reproduction(*coordinates, on, unit(), 1e-12);
    for (const double distance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
      const Vec3 off = on + distance * unit() * random_direction(random);
      if (is_inside(mesh, off)) {
        EXPECT_LT(relative_difference(solve(*coordinates, off).weights, here.weights),
                  60 * distance * std::log(1 / distance))
            << name_of(site) << ' ' << distance << ": " << on.transpose();
      }
    }
  }
}

TEST_P(GreenIn, FollowsSimilarities) {
  expect_similarities_follow(*green(), points_inside(cage(), 20, 10), unit(), 1e-11);
}

TEST_P(GreenIn, DoesNotDependOnHowTheCageIsWritten) {
  expect_invariance(make, cage(), points_inside(cage(), 12, 11), 1e-10);
}

TEST_P(GreenIn, TreatsPointsOutsideAsAsked) {
  const TriangleMesh mesh = to_triangle_mesh(cage());
  const auto refusing = green();
  const auto going_on = green(OutsideTreatment::continuation);
  Random random(12);
  int outside = 0;
  while (outside < 60) {
    const double distance = std::pow(10.0, random.uniform(-11, -0.5)) * unit();
    const Vec3 x = point_near(mesh, all_sites[random.below(7)], distance, random);
    const Solved refused = solve(*refusing, x);
    if (std::abs(winding(mesh, x)) > 1e-6 || refused.report.on_surface != 0) {
      continue;
    }
    ++outside;
    EXPECT_EQ(refused.report.outside, 1) << x.transpose();
    EXPECT_EQ(largest(refused.weights), 0);
    const Solved continued = solve(*going_on, x);
    EXPECT_EQ(continued.report.outside, 1);
    const double most = std::max(1.0, largest(continued.weights));
    EXPECT_NEAR(sum_over_vertices(*going_on, continued.weights), 1, 1e-13 * most);
    EXPECT_LT((reproduced(continued.weights, going_on->rule()->reproduced_from()) - x).norm(),
              1e-12 * most * unit());
  }
  const Result<SolvedWeights<double>> bound =
      solve_all<double>(*refusing, std::vector{Vec3(1e3, 0, 0)});
  ASSERT_FALSE(bound);
  EXPECT_EQ(bound.error().code, ErrorCode::invalid_cage);
}

TEST_P(GreenIn, IsContinuousThroughTheCage) {
  const TriangleMesh mesh = to_triangle_mesh(cage());
  const auto going_on = green(OutsideTreatment::continuation);
  Random random(13);
  for (int i = 0; i < 60; ++i) {
    const Vec3 on = point_near(mesh, Site::face, 0, random);
    const std::vector<double> here = solve(*going_on, on).weights;
    const Vec3 step = 1e-9 * unit() * random_direction(random);
    for (const Vec3& x : {Vec3(on + step), Vec3(on - step)}) {
      EXPECT_LT(relative_difference(solve(*going_on, x).weights, here), 1e-6) << on.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, GreenIn, testing::ValuesIn(law_cages()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Green, IsTheSameForEachInstructionSet) {
  const PolygonMesh cage = make_star();
  const Made made = make(cage);
  ASSERT_TRUE(made);
  const std::vector<Vec3> points = points_inside(cage, 40, 14);
  std::vector<std::vector<double>> expected;
  for (const Vec3& x : points) {
    expected.push_back(solve(**made, x).weights);
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT(relative_difference(solve(**made, points[i]).weights, expected[i]), 1e-14)
          << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Green, LeavesPointsThatAreNoneAlone) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    const Solved solved = solve(**made, Vec3(0.5, bad, 0.5));
    EXPECT_EQ(solved.report.undefined | solved.report.outside, 1);
    EXPECT_EQ(largest(solved.weights), 0);
  }
}

TEST(Green, RefusesOpenCages) {
  PolygonMesh open;
  open.positions = make_quad_cube().positions;
  for (std::size_t f = 1; f < 6; ++f) {
    open.add_face(make_quad_cube().face(f));
  }
  const Made made = make(open);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::invalid_cage);
  EXPECT_EQ(made.error().message, "the cage has 4 open or inconsistent edges");
}

TEST(Green, FollowsACageOfWhichAFaceHasCollapsed) {
  const PolygonMesh cage = PolygonMesh(make_cube());
  const Made made = make(cage);
  ASSERT_TRUE(made);
  std::vector<Vec3> pose = cage.positions;
  pose[1] = pose[0];
  const Vec3 x = moved(**made, Vec3(0.1, 0.2, 0.3), pose);
  EXPECT_TRUE(x.allFinite());
  EXPECT_LT(x.norm(), 2);
}

TEST(Green, IsOneHalfInPartsThatAreCoveredTwice) {
  TriangleMesh other = make_cube();
  for (Vec3& p : other.positions) {
    p.x() += 0.5;
  }
  const PolygonMesh cage(joined(make_cube(), other));
  const Made made = make(cage);
  ASSERT_TRUE(made);
  for (const double x : {-0.9, 0.3, 1.2}) { // in the one, in both, in the other
    expect_partition_and_reproduction(**made, Vec3(x, 0.2, -0.3), diagonal(cage.positions), 1e-12);
  }
}

} // namespace
} // namespace cagewright
