#include "quads/quads.h"

#include "core/random.h"
#include "envelope/envelope.h"
#include "improve/improve.h"
#include "mesh/shape_limits.h"
#include "mesh/shapes.h"
#include "mesh/topology.h"
#include "quads/settle_shapes.h"
#include "spatial/bvh.h"
#include "support/models.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>
#include <cagewright/validate/webbing.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

constexpr double clearance = 0.002;

/// A cage of triangles round the model.
TriangleMesh cage_of(TriangleView model, int vertices) {
  EnvelopeOptions options;
  options.clearance = clearance;
  options.vertices = vertices;
  const Result<Envelope> start = envelope(model, options);
  Result<Improved> made =
      improve(start->mesh, model, {.vertices = vertices, .clearance = clearance, .rounds = 0});
  return std::move(made->cage);
}

double diagonal_of(TriangleView model) {
  Box3 box;
  for (const Vec3& p : model.positions) {
    box.extend(p);
  }
  return box.diagonal().norm();
}

/// Each quad cut along one of its diagonals.
TriangleMesh cut_at_random(const PolygonMesh& mesh, Random& random) {
  TriangleMesh cut{mesh.positions, {}};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    const std::size_t k = face.size() == 4 ? random.below(2) : 0;
    cut.triangles.push_back({face[k], face[k + 1], face[k + 2]});
    if (face.size() == 4) {
      cut.triangles.push_back({face[k], face[k + 2], face[(k + 3) % 4]});
    }
  }
  return cut;
}

/// 2 r / R of the thinnest triangle, along any diagonals.
double least_quality(const PolygonMesh& mesh) {
  double least = 1;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> v = mesh.face(f);
    const std::size_t n = v.size();
    for (std::size_t i = 0; i < (n == 4 ? 4 : 1); ++i) {
      least = std::min(least, shape_quality({mesh.positions[v[i]], mesh.positions[v[(i + 1) % n]],
                                             mesh.positions[v[(i + 2) % n]]}));
    }
  }
  return least;
}

void expect_good_quads(const PolygonMesh& cage, TriangleView model, double kept = clearance) {
  const Result<ValidityReport> report = validate_cage(cage, model);
  ASSERT_TRUE(report && report->valid());
  const QuadReport quads = report_of(cage);
  const QuadLimits limits;
  EXPECT_LE(quads.max_bend_degrees, limits.max_bend_degrees + 1e-9);
  EXPECT_LE(quads.max_angle_degrees, limits.max_angle_degrees + 1e-9);
  EXPECT_LT(limits.max_angle_degrees, 180);
  EXPECT_GE(least_quality(cage), limits.min_quality - 1e-9);
  Random random(1);
  const TriangleBvh bvh(model);
  for (int round = 0; round < 5; ++round) {
    const TriangleMesh cut = cut_at_random(cage, random);
    const Result<ValidityReport> valid = validate_cage(TriangleView(cut), model);
    EXPECT_TRUE(valid && valid->valid());
    constexpr double rounding = 1e-9;
    EXPECT_GE(mesh_distance(TriangleBvh(cut), bvh).distance,
              (kept - rounding) * diagonal_of(model));
  }
}

TriangleMesh figure() {
  TriangleMesh limb = make_icosphere(2);
  for (Vec3& p : limb.positions) {
    p = Vec3(1.5 + p.x(), 0.15 * p.y(), 0.15 * p.z());
  }
  TriangleMesh crumb = make_icosphere(0);
  for (Vec3& p : crumb.positions) {
    p = 0.02 * p + Vec3(0, 1.1, 0);
  }
  return joined(joined(make_icosphere(3), limb), crumb);
}

struct Model {
  const char* name;
  TriangleMesh mesh;
  double share;
};

void PrintTo(const Model& model, std::ostream* out) {
  *out << model.name;
}

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = scale * p + offset;
  }
  return mesh;
}

class QuadsOf : public testing::TestWithParam<Model> {};

TEST_P(QuadsOf, AreManyAndValidAlongAnyDiagonalsAndKeepTheClearance) {
  const Model& model = GetParam();
  const TriangleMesh cage = cage_of(model.mesh, 40);
  const Result<Quadrangulated> made = make_quads(cage, model.mesh, {.clearance = clearance});
  ASSERT_TRUE(made);
  EXPECT_LE(made->cage.positions.size(), cage.positions.size());
  EXPECT_GE(made->report.share, model.share);
  EXPECT_LE(thin_share(QuadCage(made->cage)), 0.05);
  expect_good_quads(made->cage, model.mesh);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, QuadsOf,
    testing::Values(Model{"Sphere", make_icosphere(3), 0.7},
                    Model{"Torus", make_torus(0.3, 40, 20), 0.6}, Model{"Figure", figure(), 0.7},
                    Model{"TinyDistantFigure", moved(figure(), 1e-4, {10, -10, 10}), 0.7}),
    [](const auto& instance) { return std::string(instance.param.name); });

struct RealModel {
  const char* name;
  std::vector<std::string> files;
  int vertices;
  double share = shape_limits::enough_quads; // at least
};

void PrintTo(const RealModel& model, std::ostream* out) {
  *out << model.name;
}

class QuadsOfRealModel : public testing::TestWithParam<RealModel> {};

TEST_P(QuadsOfRealModel, AreMostFacesOfACharacter) {
  const auto model = test::real_model({GetParam().files[0], GetParam().files[1]});
  if (!model) {
    GTEST_SKIP() << "no such model in CAGEWRIGHT_MODELS";
  }
  const TriangleMesh cage = cage_of(*model, GetParam().vertices);
  const Result<Quadrangulated> made = make_quads(cage, *model, {.clearance = clearance});
  ASSERT_TRUE(made);
  EXPECT_GE(made->report.share, GetParam().share);
  EXPECT_LE(thin_share(QuadCage(made->cage)), 0.1);
  expect_good_quads(made->cage, *model);
}

INSTANTIATE_TEST_SUITE_P(
    Characters, QuadsOfRealModel,
    testing::Values(RealModel{"Cow", {"cow.off", "cow.obj"}, 80},
                    // One face more or less is 2 % of so few, and here there is only one start.
                    RealModel{"CowOfFewVertices", {"cow.off", "cow.obj"}, 40, 0.65},
                    RealModel{"Homer", {"homer.off", "homer.obj"}, 80},
                    RealModel{"Armadillo", {"armadillo.off", "armadillo.obj"}, 80}),
    [](const auto& instance) { return std::string(instance.param.name); });

/// Six long arms all round, as of a starfish.
TriangleMesh starfish() {
  TriangleMesh all;
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3 + 0.1;
    TriangleMesh arm = make_cube();
    for (Vec3& p : arm.positions) {
      p = Vec3(5 * p.x() + 5, 0.6 * p.y(), 0.5 * p.z());
      p = Vec3(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
               std::sin(angle) * p.x() + std::cos(angle) * p.y(), p.z());
    }
    all = k == 0 ? arm : joined(all, arm);
  }
  return all;
}

TEST(Quads, LeaveThinArmsApart) {
  // With much room while faces are paired they grow together, and stay so.
  const TriangleMesh model = starfish();
  const TriangleMesh cage = cage_of(model, 60);
  const Result<Quadrangulated> made = make_quads(cage, model, {.clearance = clearance});
  ASSERT_TRUE(made);
  expect_good_quads(made->cage, model);
  EXPECT_LE(SpaceBetween(model).share_inside(to_triangle_mesh(made->cage)), 0.05);
  EXPECT_LE(signed_volume(to_triangle_mesh(made->cage)), 1.3 * signed_volume(cage));
}

TEST(Quads, AreTheSameOnAnyNumberOfThreads) {
  const TriangleMesh model = figure();
  const TriangleMesh cage = cage_of(model, 40);
  std::vector<Result<Quadrangulated>> made;
  for (const int threads : {1, 4}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { made.push_back(make_quads(cage, model)); });
  }
  ASSERT_TRUE(made[0] && made[1]);
  EXPECT_EQ(made[0]->cage.positions, made[1]->cage.positions);
  EXPECT_TRUE(std::ranges::equal(made[0]->cage.corners(), made[1]->cage.corners()));
}

/// The half at x >= 0 of an octahedron, subdivided onto a sphere.
TriangleMesh half_sphere(double radius, int subdivisions) {
  TriangleMesh mesh{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
  for (int k = 0; k < subdivisions; ++k) {
    TriangleMesh next{mesh.positions, {}};
    const auto middle = [&](Index a, Index b) {
      const Vec3 p = (mesh.positions[a] + mesh.positions[b]).normalized();
      for (Index v = 0; v < next.positions.size(); ++v) {
        if (next.positions[v] == p) {
          return v;
        }
      }
      next.positions.push_back(p);
      return static_cast<Index>(next.positions.size() - 1);
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b);
      const Index bc = middle(b, c);
      const Index ca = middle(c, a);
      next.triangles.insert(next.triangles.end(),
                            {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh = std::move(next);
  }
  for (Vec3& p : mesh.positions) {
    p *= radius;
  }
  return mesh;
}

TEST(Quads, OfHalfACageMakeAValidWholeWithItsMirrorImage) {
  const TriangleMesh half = half_sphere(1.2, 2);
  const TriangleMesh model = make_icosphere(3);
  const Result<Quadrangulated> made = make_quads(half, model);
  ASSERT_TRUE(made);
  EXPECT_GE(made->report.share, 0.6);
  PolygonMesh whole = made->cage;
  std::vector<Index> image(whole.positions.size());
  for (Index v = 0; v < image.size(); ++v) {
    const Vec3 p = made->cage.positions[v];
    EXPECT_GE(p.x(), 0);
    image[v] = p.x() == 0 ? v : static_cast<Index>(whole.positions.size());
    if (p.x() != 0) {
      whole.positions.emplace_back(-p.x(), p.y(), p.z());
    }
  }
  for (std::size_t f = 0; f < made->cage.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : made->cage.face(f)) {
      face.insert(face.begin(), image[v]);
    }
    whole.add_face(face);
  }
  expect_good_quads(whole, model);
}

/// A box of three cells in a row along x, with 14 faces.
PolygonMesh three_cells(const std::array<double, 4>& x, double half_width) {
  PolygonMesh mesh;
  for (const double at : x) {
    for (const auto& [y, z] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      mesh.positions.emplace_back(at, y * half_width, z * half_width);
    }
  }
  mesh.add_face({3, 2, 1, 0});
  for (Index cell = 0; cell < 3; ++cell) {
    for (Index k = 0; k < 4; ++k) {
      const Index next = (k + 1) % 4;
      mesh.add_face({4 * cell + k, 4 * cell + next, 4 * cell + 4 + next, 4 * cell + 4 + k});
    }
  }
  mesh.add_face({12, 13, 14, 15});
  return mesh;
}

TEST(SettleShapes, MakesThinQuadsRounder) {
  const TriangleMesh model = make_icosphere(3);
  QuadCage cage(three_cells({-1.2, -1.1, 1.1, 1.2}, 1.2));
  EXPECT_NEAR(thin_share(cage), 8.0 / 14, 1e-9);
  const ModelSurface surface(model, 0);
  const QuadGuard guard(surface, clearance * surface.diagonal, {});
  const Objective objective(surface, {});
  settle_shapes(cage, guard, objective, {});
  EXPECT_LE(thin_share(cage), 0.05);
  expect_good_quads(cage.to_polygons(), model);
}

TEST(SettleShapes, LeavesACageOfGoodQuadsAsItIs) {
  const TriangleMesh model = make_icosphere(3);
  QuadCage cage(three_cells({-1.2, -0.5, 0.5, 1.2}, 1.2));
  const std::vector<Vec3> before = cage.positions();
  const ModelSurface surface(model, 0);
  const QuadGuard guard(surface, clearance * surface.diagonal, {});
  const Objective objective(surface, {});
  settle_shapes(cage, guard, objective, {});
  EXPECT_EQ(cage.positions(), before);
}

TEST(SettleShapes, LeavesALongArmThinRatherThanMakeItMuchWider) {
  const TriangleMesh model = [] {
    TriangleMesh bar = make_cube();
    for (Vec3& p : bar.positions) {
      p = p.cwiseProduct(Vec3(92, 0.9, 0.9));
    }
    return bar;
  }();
  QuadCage cage(three_cells({-93, -30, 30, 93}, 1));
  const double volume = signed_volume(to_triangle_mesh(cage.to_polygons()));
  ASSERT_GT(thin_share(cage), 0.5);
  const ModelSurface surface(model, 0);
  const QuadGuard guard(surface, 0.05, {});
  const Objective objective(surface, {});
  settle_shapes(cage, guard, objective, {});
  EXPECT_LE(signed_volume(to_triangle_mesh(cage.to_polygons())), 1.8 * volume);
}

TEST(Quads, OfNothingOrOfAnOpenCageAreRefused) {
  const TriangleMesh model = make_icosphere(1);
  EXPECT_EQ(make_quads({}, model).error().code, ErrorCode::invalid_cage);
  const TriangleMesh cage = moved(make_icosphere(1), 1.5, {0, 0, 0});
  EXPECT_EQ(make_quads(cage, {}).error().code, ErrorCode::unfit_model);
  TriangleMesh open = moved(cage, 1, {3, 0, 0});
  open.triangles.pop_back();
  EXPECT_EQ(make_quads(open, model).error().code, ErrorCode::invalid_cage);
  EXPECT_EQ(make_quads(cage, model, {.clearance = 0}).error().code, ErrorCode::invalid_option);
}

TEST(Quads, CanBeCancelled) {
  const TriangleMesh model = make_icosphere(1);
  StopFlag source;
  source.request_stop();
  const Progress progress(source);
  const auto made = make_quads(moved(model, 1.5, {0, 0, 0}), model, {}, progress);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

TEST(PairCoplanar, GivesTheCubeItsSixFaces) {
  const PolygonMesh cube = pair_coplanar(make_cube());
  EXPECT_EQ(cube.face_count(), 6U);
  EXPECT_EQ(report_of(cube).quads, 6U);
  EXPECT_EQ(report_of(cube).rings, 3U);
  EXPECT_TRUE(topology(cube).is_closed());
}

TEST(QuadReport, CountsThinTriangles) {
  PolygonMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0.05, 0}, {2, 0, 0}};
  mesh.add_face({0, 1, 2, 3});
  mesh.add_face({0, 1, 4});
  mesh.add_face({1, 5, 2});
  EXPECT_EQ(report_of(mesh).thin, 0.25); // one of four; the quad has two
}

TEST(PairCoplanar, LeavesASurfaceThatIsNowhereFlat) {
  EXPECT_EQ(report_of(pair_coplanar(make_icosphere(1))).quads, 0U);
}

} // namespace
} // namespace cagewright
