#include "quads/grid_quads.h"

#include "mesh/shapes.h"
#include "mesh/topology.h"
#include "quads/grid_layout.h"
#include "spatial/bvh.h"
#include "support/figures.h"
#include "support/models.h"
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace cagewright {
namespace {

using test::ellipsoid;

/// A body with four limbs, its own mirror image in the plane x = 0.
TriangleMesh figure() {
  TriangleMesh mesh = ellipsoid({0, 0, 0}, {0.8, 1.6, 0.7});
  for (const double side : {-1.0, 1.0}) {
    mesh = joined(mesh, ellipsoid({side * 1.7, 0.9, 0.1}, {1.4, 0.22, 0.22}));
    mesh = joined(mesh, ellipsoid({side * 0.5, -2.2, 0}, {0.24, 1.6, 0.24}));
  }
  return mesh;
}

/// The mirror image of a half, and the half.
PolygonMesh whole_of(const PolygonMesh& half) {
  PolygonMesh whole = half;
  std::vector<Index> image(half.positions.size());
  for (Index v = 0; v < image.size(); ++v) {
    const Vec3 p = half.positions[v];
    image[v] = p.x() == 0 ? v : static_cast<Index>(whole.positions.size());
    if (p.x() != 0) {
      whole.positions.emplace_back(-p.x(), p.y(), p.z());
    }
  }
  for (std::size_t f = 0; f < half.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : half.face(f)) {
      face.insert(face.begin(), image[v]);
    }
    whole.add_face(face);
  }
  return whole;
}

/// Each quad cut along its other diagonal.
TriangleMesh cut_the_other_way(const PolygonMesh& mesh) {
  TriangleMesh cut{mesh.positions, {}};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> v = mesh.face(f);
    cut.triangles.push_back({v[1], v[2], v[v.size() == 4 ? 3 : 0]});
    if (v.size() == 4) {
      cut.triangles.push_back({v[3], v[0], v[1]});
    }
  }
  return cut;
}

void expect_good(const PolygonMesh& cage, TriangleView model) {
  const Result<ValidityReport> valid = validate_cage(cage, model);
  EXPECT_TRUE(valid && valid->valid());
  const QuadReport report = report_of(cage);
  EXPECT_GE(report.share, 0.9);
  EXPECT_LE(report.max_bend_degrees, 40 + 1e-9);
  EXPECT_LE(report.max_angle_degrees, 160 + 1e-9);
  EXPECT_GE(report.min_angle_degrees, 20 - 1e-9);
  const TriangleMesh cut = cut_the_other_way(cage);
  const Result<ValidityReport> other = validate_cage(TriangleView(cut), model);
  EXPECT_TRUE(other && other->valid());
  Box3 box;
  for (const Vec3& p : model.positions) {
    box.extend(p);
  }
  constexpr double clearance = 0.002;
  EXPECT_GE(mesh_distance(TriangleBvh(cut), TriangleBvh(model)).distance,
            (clearance - 1e-9) * box.diagonal().norm());
}

TEST(SolidGrid, IsItsOwnMirrorImageForAHalf) {
  const Result<SolidGrid> solid =
      solid_grid(figure(), {.resolution = 40, .clearance = 0.01, .half = true});
  ASSERT_TRUE(solid);
  const int n = solid->dims()[0];
  EXPECT_EQ(solid->low()[0], n - solid->high()[0]);
  for (int k = 0; k < solid->dims()[2]; ++k) {
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(solid->touches({i, 0, k}, {i + 1, solid->dims()[1], k + 1}),
                solid->touches({n - 1 - i, 0, k}, {n - i, solid->dims()[1], k + 1}));
    }
  }
}

TEST(GridLayout, IsAClosedSurfaceOfQuadsWithinTheBudget) {
  const TriangleMesh model = figure();
  const Result<SolidGrid> solid = solid_grid(model, {.resolution = 40, .clearance = 0.01});
  ASSERT_TRUE(solid);
  double last = std::numeric_limits<double>::infinity();
  for (const int vertices : {40, 80, 160}) {
    const GridLayout layout = grid_layout(*solid, {.vertices = vertices});
    const PolygonMesh surface = surface_of(layout, *solid, false);
    EXPECT_LE(layout.vertices, static_cast<std::size_t>(vertices));
    EXPECT_EQ(surface.positions.size(), layout.vertices);
    EXPECT_EQ(surface.face_count(), layout.vertices - 2); // of a sphere of quads
    EXPECT_TRUE(topology(surface).is_closed());
    const Result<ValidityReport> valid = validate_cage(surface, model);
    EXPECT_TRUE(valid && valid->valid());
    EXPECT_LT(layout.volume, last);
    last = layout.volume;
  }
}

TEST(GridQuads, AreAllQuadsWithRingsRoundTheLimbs) {
  const TriangleMesh model = figure();
  const Result<Quadrangulated> made = make_grid_quads(model, {.vertices = 48});
  ASSERT_TRUE(made);
  EXPECT_LE(made->cage.positions.size(), 48U);
  EXPECT_GE(made->report.rings, 4U);
  expect_good(made->cage, model);
}

TEST(GridQuads, OfHalfAModelMakeAValidWholeWithTheirMirrorImage) {
  const TriangleMesh model = figure();
  const Result<Quadrangulated> made = make_grid_quads(model, {.vertices = 60, .half = true});
  ASSERT_TRUE(made);
  for (const Vec3& p : made->cage.positions) {
    EXPECT_GE(p.x(), 0);
  }
  const PolygonMesh whole = whole_of(made->cage);
  EXPECT_LE(whole.positions.size(), 60U);
  expect_good(whole, model);
}

TEST(GridQuads, OfARealModelKeepTheBudgetOfFaces) {
  const auto model = test::real_model({"cow.off", "cow.obj"});
  if (!model) {
    GTEST_SKIP() << "no such model in CAGEWRIGHT_MODELS";
  }
  const Result<Quadrangulated> made = make_grid_quads(*model, {.vertices = 0, .faces = 40});
  ASSERT_TRUE(made);
  EXPECT_LE(made->cage.face_count(), 40U);
  expect_good(made->cage, *model);
}

TEST(GridQuads, AreTheSameOnAnyNumberOfThreads) {
  const TriangleMesh model = figure();
  std::vector<Result<Quadrangulated>> made;
  for (const int threads : {1, 4}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { made.push_back(make_grid_quads(model, {.vertices = 30})); });
  }
  ASSERT_TRUE(made[0] && made[1]);
  EXPECT_EQ(made[0]->cage.positions, made[1]->cage.positions);
  EXPECT_TRUE(std::ranges::equal(made[0]->cage.corners(), made[1]->cage.corners()));
}

TEST(GridQuads, CanBeCancelled) {
  StopFlag source;
  source.request_stop();
  const auto made = make_grid_quads(figure(), {}, Progress(source));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

TEST(GridQuads, AreGivenUpWhenTheyWouldBeTooLoose) {
  const auto made = make_grid_quads(figure(), {.vertices = 30, .loosest = 1e-3});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::no_valid_cage);
}

TEST(GridQuads, NeedABudgetThatABlockFitsIn) {
  EXPECT_EQ(make_grid_quads(figure(), {.vertices = 7}).error().code, ErrorCode::invalid_option);
}

} // namespace
} // namespace cagewright
