#include <cagewright/coordinates/mean_value.h>

#include "coordinates/points_near.h"
#include "coordinates/reference.h"
#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

namespace cagewright {
namespace {

struct Cage {
  std::string name;
  TriangleMesh mesh;

  friend void PrintTo(const Cage& cage, std::ostream* out) { *out << cage.name; }
};

/// Sheared and moved, so that no plane or line of the cage is aligned with the axes.
TriangleMesh skewed(TriangleMesh mesh) {
  for (Vec3& p : mesh.positions) {
    p = Vec3(1.1 * p.x() + 0.1, 0.9 * p.y() + 0.03 * p.x(), p.z() + 0.02 * p.y());
  }
  return mesh;
}

/// Faces lie in common planes, edges on common lines, and the middle is outside.
TriangleMesh make_concave_block() {
  TriangleMesh mesh = make_cube();
  mesh.positions.emplace_back(0, 0, 0); // the middle of the top is pulled down to here
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [](Index v) { return (v & 4U) != 0; });
  });
  for (const auto& [from, to] : {std::pair<Index, Index>{4, 5}, {5, 7}, {7, 6}, {6, 4}}) {
    mesh.triangles.push_back({from, to, 8});
  }
  return mesh;
}

TriangleMesh two_cubes() {
  TriangleMesh other = make_cube();
  for (Vec3& p : other.positions) {
    p = p * 0.6 + Vec3(2.5, 0, 0);
  }
  return joined(make_cube(), other);
}

std::vector<Cage> cages() {
  return {{"Cube", make_cube()},
          {"SkewedCube", skewed(make_cube())},
          {"Tetrahedron", skewed(make_tetrahedron())},
          {"Sphere", skewed(make_icosphere(1))},
          {"Torus", skewed(make_torus(0.35, 8, 5))},
          {"ConcaveBlock", make_concave_block()},
          {"TwoCubes", two_cubes()}};
}

std::vector<double> weights_of(const MeanValueSolver& solver, const Vec3& point) {
  const std::size_t count = solver.columns();
  std::vector<double> tile(16 * count);
  const TileReport report = solver.solve(std::span(&point, 1), tile);
  EXPECT_EQ(report.undefined, 0) << point.transpose();
  std::vector<double> weights(count);
  for (std::size_t c = 0; c < count; ++c) {
    weights[c] = tile[c * 16];
  }
  return weights;
}

template <class T> Vec3 reproduced(const std::vector<T>& weights, std::span<const Vec3> cage) {
  Vec3 x = Vec3::Zero();
  for (std::size_t c = 0; c < cage.size(); ++c) {
    x += static_cast<double>(weights[c]) * cage[c];
  }
  return x;
}

/// The greatest difference, relative to the largest weight.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  double worst = 0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    largest = std::max(largest, std::abs(b[c]));
    worst = std::max(worst, std::abs(a[c] - b[c]));
  }
  return worst / largest;
}

MeanValueSolver solver_for(TriangleView cage) {
  Result<MeanValueSolver> solver = MeanValueSolver::create(cage);
  EXPECT_TRUE(solver) << solver.error().message;
  return *std::move(solver);
}

class MeanValueNear : public testing::TestWithParam<std::tuple<Cage, test::Site>> {};

TEST_P(MeanValueNear, AgreesWithTheDefinitionAtEveryDistance) {
  const auto& [cage, site] = GetParam();
  const double unit = diagonal(cage.mesh.positions);
  const MeanValueSolver solver = solver_for(cage.mesh);
  Random random(11);
  for (const double distance : {0.0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7,
                                1e-6, 1e-5, 1e-4, 1e-3, 4e-3, 1e-2, 1e-1}) {
    for (int i = 0; i < 6; ++i) {
      const Vec3 point = test::point_near(cage.mesh, site, distance * unit, random);
      const std::vector<double> weights = weights_of(solver, point);
      EXPECT_LT(difference(weights, test::reference_weights(cage.mesh, point)), 1e-12)
          << distance << " of the diagonal away: " << point.transpose();
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-13);
      EXPECT_LT((reproduced(weights, cage.mesh.positions) - point).norm(), 1e-13 * unit);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllCages, MeanValueNear,
                         testing::Combine(testing::ValuesIn(cages()),
                                          testing::Values(test::Site::face, test::Site::edge,
                                                          test::Site::vertex, test::Site::plane,
                                                          test::Site::line, test::Site::beside,
                                                          test::Site::at_corner)),
                         [](const auto& tested) {
                           return std::get<0>(tested.param).name +
                                  test::name_of(std::get<1>(tested.param));
                         });

class MeanValueIn : public testing::TestWithParam<Cage> {};

TEST_P(MeanValueIn, AgreesWithTheDefinitionInsideAndOutside) {
  const TriangleMesh& cage = GetParam().mesh;
  const MeanValueSolver solver = solver_for(cage);
  const Box3 box = bounding_box(cage);
  Random random(12);
  for (int i = 0; i < 60; ++i) {
    const Vec3 offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Vec3 point = box.center() + offset.cwiseProduct(box.sizes());
    EXPECT_LT(difference(weights_of(solver, point), test::reference_weights(cage, point)), 1e-12)
        << point.transpose();
  }
}

TEST_P(MeanValueIn, AgreesWithTheDefinitionFarOutside) {
  const TriangleMesh& cage = GetParam().mesh;
  const MeanValueSolver solver = solver_for(cage);
  const double unit = diagonal(cage.positions);
  const Vec3 center = bounding_box(cage).center();
  Random random(21);
  // Small steps at first: there the formulas meet.
  for (double distance = 0.4; distance < 2e6; distance *= distance < 8 ? 1.2 : 4) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 point = center + distance * unit * test::random_direction(random);
      const std::vector<double> weights = weights_of(solver, point);
      if (distance < 2e3) { // beyond, 113 bits do not suffice for the reference
        EXPECT_LT(difference(weights, test::reference_weights(cage, point)), 1e-12)
            << distance << " diagonals away: " << point.transpose();
      }
      EXPECT_LT((reproduced(weights, cage.positions) - point).norm(), 1e-13 * (1 + distance) * unit)
          << distance;
    }
  }
}

TEST_P(MeanValueIn, DoesNotDependOnUnitOrOrigin) {
  const TriangleMesh& cage = GetParam().mesh;
  const MeanValueSolver solver = solver_for(cage);
  Random random(13);
  for (const auto& [unit, origin] : {std::pair(1e-6, 0.0), {1e6, 0.0}, {1e-3, 7.0}, {3e5, -1e7}}) {
    TriangleMesh moved = cage;
    for (Vec3& p : moved.positions) {
      p = p * unit + Vec3::Constant(origin);
    }
    const MeanValueSolver moved_solver = solver_for(moved);
    const double lost = 1e-14 * (1 + std::abs(origin) / unit); // digits that the input has not
    for (int i = 0; i < 20; ++i) {
      const Vec3 point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 moved_point = point * unit + Vec3::Constant(origin);
      EXPECT_LT(difference(weights_of(moved_solver, moved_point), weights_of(solver, point)),
                1e-11 + 100 * lost);
    }
  }
}

TEST_P(MeanValueIn, DoesNotCareWhichWayTheCageIsTurned) {
  const TriangleMesh& cage = GetParam().mesh;
  TriangleMesh inverted = cage;
  for (Triangle& t : inverted.triangles) {
    std::swap(t[0], t[1]);
  }
  const MeanValueSolver solver = solver_for(cage);
  const MeanValueSolver other = solver_for(inverted);
  Random random(14);
  for (int i = 0; i < 20; ++i) {
    const Vec3 point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    EXPECT_LT(difference(weights_of(other, point), weights_of(solver, point)), 1e-12);
  }
}

// Along a line through a face, the plane of a face, an edge and a vertex the weights change by no
// more than the step explains: a threshold that switches formulas leaves no jump.
TEST_P(MeanValueIn, DoesNotJumpOnTheWayThroughTheSurface) {
  const TriangleMesh& cage = GetParam().mesh;
  const double unit = diagonal(cage.positions);
  const MeanValueSolver solver = solver_for(cage);
  Random random(15);
  for (const test::Site site : {test::Site::face, test::Site::edge, test::Site::vertex,
                                test::Site::plane, test::Site::line}) {
    for (int line = 0; line < 8; ++line) {
      const Vec3 target = test::point_near(cage, site, 0, random);
      const Vec3 direction = test::random_direction(random);
      for (double distance = 1e-16; distance < 0.05; distance *= 1.1) {
        const Vec3 here = target + direction * distance * unit;
        const Vec3 there = target + direction * distance * 1.1 * unit;
        const double step = (there - here).norm() / unit;
        EXPECT_LT(difference(weights_of(solver, here), weights_of(solver, there)),
                  1e-12 + 300 * step)
            << distance;
      }
    }
  }
}

TEST_P(MeanValueIn, PreviewsToWithinAHundredThousandthOfTheDiagonal) {
  const TriangleMesh& cage = GetParam().mesh;
  const double unit = diagonal(cage.positions);
  const MeanValueSolver solver = solver_for(cage);
  Random random(16);
  std::vector<float> tile(16 * cage.positions.size());
  std::vector<float> row(cage.positions.size());
  for (const test::Site site : {test::Site::face, test::Site::edge, test::Site::vertex}) {
    for (const double distance : {0.0, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
      for (int i = 0; i < 20; ++i) {
        const Vec3 point = test::point_near(cage, site, distance * unit, random);
        solver.preview(std::span(&point, 1), tile);
        for (std::size_t c = 0; c < row.size(); ++c) {
          row[c] = tile[c * 16];
        }
        EXPECT_LT((reproduced(row, cage.positions) - point).norm(), 1e-5 * unit) << distance;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllCages, MeanValueIn, testing::ValuesIn(cages()),
                         [](const auto& tested) { return tested.param.name; });

TEST(MeanValue, IsPositiveInsideAConvexCage) {
  const TriangleMesh cage = skewed(make_icosphere(1));
  const MeanValueSolver solver = solver_for(cage);
  Random random(17);
  for (int i = 0; i < 200; ++i) {
    const Vec3 point = Vec3(0.1, 0, 0) + 0.8 * random.uniform() * test::random_direction(random);
    const std::vector<double> weights = weights_of(solver, point);
    EXPECT_GE(*std::min_element(weights.begin(), weights.end()), 0);
  }
}

TEST(MeanValue, TakesTheBarycentricCoordinatesOfTheFaceOnTheCage) {
  const TriangleMesh cage = make_cube();
  const MeanValueSolver solver = solver_for(cage);
  const Triangle& t = cage.triangles[5];
  const Vec3 point =
      0.5 * cage.positions[t[0]] + 0.25 * cage.positions[t[1]] + 0.25 * cage.positions[t[2]];
  std::vector<double> tile(16 * 8);
  EXPECT_EQ(solver.solve(std::span(&point, 1), tile).on_surface, 1);
  const std::vector<double> weights = weights_of(solver, point);
  EXPECT_DOUBLE_EQ(weights[t[0]], 0.5);
  EXPECT_DOUBLE_EQ(weights[t[1]], 0.25);
  EXPECT_DOUBLE_EQ(weights[t[2]], 0.25);
}

TEST(MeanValue, IsOneAtAVertexExactly) {
  const TriangleMesh cage = skewed(make_torus(0.35, 8, 5));
  const MeanValueSolver solver = solver_for(cage);
  for (std::size_t v = 0; v < cage.positions.size(); ++v) {
    const std::vector<double> weights = weights_of(solver, cage.positions[v]);
    for (std::size_t c = 0; c < weights.size(); ++c) {
      EXPECT_EQ(weights[c], c == v ? 1 : 0);
    }
  }
}

TEST(MeanValue, IgnoresVerticesWithoutFacesAndFacesWithoutArea) {
  const TriangleMesh cube = make_cube();
  TriangleMesh cage = cube;
  cage.positions.emplace_back(0.1, 0.2, 0.3); // where the point is
  cage.positions.push_back(Vec3::Constant(std::numeric_limits<double>::infinity()));
  cage.triangles.push_back({0, 1, 1});
  cage.triangles.push_back({1, 0, 1});
  const Vec3 point(0.1, 0.2, 0.3);
  std::vector<double> weights = weights_of(solver_for(cage), point);
  EXPECT_EQ(weights[8], 0);
  EXPECT_EQ(weights[9], 0);
  weights.resize(8);
  EXPECT_LT(difference(weights, weights_of(solver_for(cube), point)), 1e-13);
}

// A vertex in the middle of a straight edge: the neighbour on its other side keeps the long edge,
// and a triangle without area closes the gap.
TEST(MeanValue, HoldsAcrossATriangleWithoutArea) {
  TriangleMesh cage = make_cube();
  cage.positions.emplace_back(0, -1, -1); // on the edge 0 1
  auto& first = *std::find_if(cage.triangles.begin(), cage.triangles.end(), [](const Triangle& t) {
    return std::count(t.begin(), t.end(), 0U) + std::count(t.begin(), t.end(), 1U) == 2;
  });
  while (first[0] == 0 || first[0] == 1) {
    std::rotate(first.begin(), first.begin() + 1, first.end());
  }
  const auto [top, from, to] = std::tuple(first[0], first[1], first[2]);
  first = {top, from, 8};
  cage.triangles.push_back({top, 8, to});
  cage.triangles.push_back({from, to, 8});
  const Vec3 point(0.3, -0.2, 0.1);
  const std::vector<double> weights = weights_of(solver_for(cage), point);
  EXPECT_LT((reproduced(weights, cage.positions) - point).norm(), 1e-14);
}

TEST(MeanValue, LeavesPointsThatAreNoNumbersWithoutWeights) {
  const MeanValueSolver solver = solver_for(make_cube());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points = {{0, 0, 0}, {nan, 0, 0}, {0, 1e300, 0}, {0.5, 0, 0}};
  std::vector<double> tile(16 * 8);
  EXPECT_EQ(solver.solve(points, tile).undefined, 0b0110);
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_EQ(tile[c * 16 + 1], 0);
    EXPECT_EQ(tile[c * 16 + 2], 0);
    EXPECT_GT(tile[c * 16 + 3], 0);
  }
}

TEST(MeanValue, OfNoPointsIsEmpty) {
  const Result<Weights> weights = mean_value_coordinates(make_cube(), {});
  ASSERT_TRUE(weights);
  EXPECT_EQ(weights->points(), 0U);
  std::vector<double> tile(16 * 8, 7.0);
  EXPECT_EQ(solver_for(make_cube()).solve({}, tile).undefined, 0);
  EXPECT_EQ(tile, std::vector<double>(16 * 8, 0.0));
}

TEST(MeanValue, RefusesWhatIsNoCage) {
  const auto message = [](TriangleMesh cage) {
    const Result<MeanValueSolver> solver = MeanValueSolver::create(TriangleView(cage));
    EXPECT_FALSE(solver);
    EXPECT_EQ(solver.error().code, ErrorCode::invalid_cage);
    return solver.error().message;
  };
  TriangleMesh open = make_cube();
  open.triangles.pop_back();
  TriangleMesh wild = make_cube();
  wild.triangles[3][1] = 8;
  TriangleMesh infinite = make_cube();
  infinite.positions[2].y() = std::numeric_limits<double>::infinity();
  TriangleMesh point = make_cube();
  for (Vec3& p : point.positions) {
    p.setOnes();
  }
  TriangleMesh flat = make_cube();
  for (Vec3& p : flat.positions) {
    p.y() = p.z() = p.x();
  }
  EXPECT_EQ(message({}), "the cage has no faces");
  EXPECT_EQ(message(open), "the cage has 3 open or inconsistent edges");
  EXPECT_EQ(message(wild), "triangle 3 of the cage refers to vertex 8, but there are 8");
  EXPECT_EQ(message(infinite), "vertex 2 of the cage is not finite");
  EXPECT_EQ(message(point), "the cage has no extent");
  EXPECT_EQ(message(flat), "the faces of the cage have no area");
}

TEST(MeanValue, StillSumsToOneInAnOpenCageThatIsAllowed) {
  TriangleMesh open = make_cube();
  open.triangles.pop_back();
  const Result<MeanValueSolver> solver = MeanValueSolver::create(open, {.allow_open = true});
  ASSERT_TRUE(solver);
  const std::vector<double> weights = weights_of(*solver, {0.2, 0.1, 0});
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-14);
}

PolygonMesh cube_of_quads() {
  PolygonMesh cube = make_quad_cube();
  cube.positions[7] = {1.4, 1.1, 0.9}; // three quads are not flat
  return cube;
}

TEST(MeanValueOfQuads, ReproducesPointsWithEitherTreatment) {
  const PolygonMesh cage = cube_of_quads();
  const std::vector<Vec3> points = {{0.2, 0.1, -0.3}, {0.9, 0.9, 0.8}, {2, 0, 1}, {1, 0, 0}};
  for (const QuadTreatment quads : {QuadTreatment::center, QuadTreatment::diagonal}) {
    const Result<Weights> weights = mean_value_coordinates(cage, points, {.quads = quads});
    ASSERT_TRUE(weights) << weights.error().message;
    for (std::size_t p = 0; p < points.size(); ++p) {
      EXPECT_LT((reproduced(weights->row(p), cage.positions) - points[p]).norm(), 1e-14);
    }
  }
}

TEST(MeanValueOfQuads, IsBilinearInTheMiddleAndOnTheEdges) {
  const PolygonMesh cage = cube_of_quads();
  const auto& x = cage.positions;
  const std::vector<Vec3> points = {(x[1] + x[3] + x[7] + x[5]) / 4, 0.25 * x[3] + 0.75 * x[7]};
  const Result<Weights> weights = mean_value_coordinates(cage, points);
  ASSERT_TRUE(weights);
  for (const Index corner : {1U, 3U, 7U, 5U}) {
    EXPECT_NEAR(weights->at(0, corner), 0.25, 1e-14);
  }
  EXPECT_NEAR(weights->at(1, 3), 0.25, 1e-14);
  EXPECT_NEAR(weights->at(1, 7), 0.75, 1e-14);
}

TEST(MeanValueOfQuads, DoesNotDependOnHowAQuadIsWrittenDown) {
  const PolygonMesh cage = cube_of_quads();
  PolygonMesh turned;
  turned.positions = cage.positions;
  for (std::size_t f = cage.face_count(); f-- > 0;) {
    const std::span<const Index> q = cage.face(f);
    turned.add_face({q[1], q[2], q[3], q[0]});
  }
  const std::vector<Vec3> points = {{0.2, 0.1, -0.3}, {1.05, 0.7, 0.6}};
  const Result<Weights> a = mean_value_coordinates(cage, points);
  const Result<Weights> b = mean_value_coordinates(turned, points);
  ASSERT_TRUE(a && b);
  for (std::size_t p = 0; p < points.size(); ++p) {
    EXPECT_LT(difference(a->row(p), b->row(p)), 1e-13);
  }
}

std::vector<Vec3> many_points(std::size_t count) {
  Random random(18);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) {
    p = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  return points;
}

TEST(MeanValueBinding, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh cage = skewed(make_torus(0.35, 8, 5));
  const std::vector<Vec3> points = many_points(1003);
  const auto bind = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return mean_value_coordinates(cage, points); });
  };
  const Result<Weights> one = bind(1);
  const Result<Weights> four = bind(4);
  ASSERT_TRUE(one && four);
  for (std::size_t t = 0; t < one->tile_count(); ++t) {
    ASSERT_TRUE(std::ranges::equal(one->tile(t), four->tile(t)));
  }
}

TEST(MeanValueBinding, FillsTheLastTileWithZeros) {
  const Result<Weights> weights = mean_value_coordinates(make_cube(), many_points(515));
  ASSERT_TRUE(weights);
  ASSERT_EQ(weights->tile_count(), 2U);
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NE(weights->tile(1)[c * 512 + 2], 0);
    for (std::size_t i = 3; i < 512; ++i) {
      EXPECT_EQ(weights->tile(1)[c * 512 + i], 0);
    }
  }
}

TEST(MeanValueBinding, StoresTheNearestFloats) {
  const TriangleMesh cage = make_icosphere(1);
  const std::vector<Vec3> points = many_points(50);
  const MeanValueSolver solver = solver_for(cage);
  const auto exact = solve_all<double>(solver, points);
  const auto rounded = solve_all<float>(solver, points);
  ASSERT_TRUE(exact && rounded);
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t c = 0; c < cage.positions.size(); ++c) {
      ASSERT_EQ(rounded->weights.at(p, c), static_cast<float>(exact->weights.at(p, c)));
    }
  }
}

TEST(MeanValueBinding, StopsWhenAsked) {
  StopFlag stop;
  std::size_t reports = 0;
  const Progress progress(stop, [&](double, std::string_view) {
    ++reports;
    stop.request_stop();
  });
  const std::vector<Vec3> points = many_points(100000);
  const Result<Weights> weights = mean_value_coordinates(make_cube(), points, {}, progress);
  ASSERT_FALSE(weights);
  EXPECT_EQ(weights.error().code, ErrorCode::cancelled);
  EXPECT_LT(reports, 100U);
}

// The library runs on machines without AVX-512 too.
TEST(MeanValueInstructionSets, AllAgreeWithTheDefinition) {
  const TriangleMesh cage = skewed(make_torus(0.35, 8, 5));
  const MeanValueSolver solver = solver_for(cage);
  const double unit = diagonal(cage.positions);
  const std::int64_t supported = hwy::SupportedTargets();
  for (std::int64_t targets = supported; targets != 0; targets &= targets - 1) {
    // The targets are bits, the best the lowest: take away the best, one after the other.
    hwy::SetSupportedTargetsForTest(targets);
    Random random(19);
    for (const test::Site site : {test::Site::face, test::Site::edge, test::Site::vertex,
                                  test::Site::plane, test::Site::beside}) {
      for (const double distance : {0.0, 1e-12, 1e-6, 1e-3, 1e-1}) {
        const Vec3 point = test::point_near(cage, site, distance * unit, random);
        EXPECT_LT(difference(weights_of(solver, point), test::reference_weights(cage, point)),
                  1e-12)
            << hwy::TargetName(targets & -targets) << ' ' << distance;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

} // namespace
} // namespace cagewright
