#include <cagewright/coordinates/bounded_biharmonic.h>

#include "coordinates/delaunay.h"
#include "coordinates/inside_mesh.h"
#include "coordinates/laws.h"

#include <map>

namespace cagewright {
namespace {

using namespace cagewright::test;

TEST(BoundedBiharmonic, HasTheGoldenValues) {
  const Made made = bounded_biharmonic_coordinates(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, Vec3(.25, .375, .25)).weights;
  const std::vector<double> expected = {.424, .097, .212, .068, .097, .026, .068, .008};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], expected[c], 0.01);
  }
  EXPECT_GT((*made)->error_estimate(), 0);
  EXPECT_LT((*made)->error_estimate(), 0.03);
}

TEST(BoundedBiharmonic, HardlyChangesWithTwiceAsManyPoints) {
  const Made coarse = bounded_biharmonic_coordinates(make_star(), {.points = 2000});
  const Made fine = bounded_biharmonic_coordinates(make_star(), {.points = 4000});
  ASSERT_TRUE(coarse && fine);
  double sum = 0;
  const std::vector<Vec3> points = points_inside(make_star(), 60, 71);
  for (const Vec3& x : points) {
    const double off = relative_difference(solve(**coarse, x).weights, solve(**fine, x).weights);
    EXPECT_LT(off, 0.07) << x.transpose();
    sum += off;
  }
  EXPECT_LT(sum / static_cast<double>(points.size()), 0.015);
}

TEST(BoundedBiharmonic, StopsWhenAsked) {
  StopFlag stop;
  stop.request_stop();
  const Made made = bounded_biharmonic_coordinates(golden_cube(), {}, Progress(stop));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

/// Tetrahedra fill the cage, and meet face to face.
TEST(InsideMesh, FillsTheCage) {
  for (const LawCage& cage : law_cages()) {
    const Result<Surface> surface = Surface::create(cage.mesh, QuadTreatment::center);
    ASSERT_TRUE(surface);
    const Result<InsideMesh> mesh = inside_mesh(*surface, spacing_for(*surface, 2000), {});
    ASSERT_TRUE(mesh) << cage.name;
    double volume = 0;
    std::map<std::array<Index, 3>, int> uses;
    for (const auto& cell : mesh->cells) {
      const Vec3& o = mesh->positions[cell[0]];
      volume += std::abs((mesh->positions[cell[1]] - o)
                             .cross(mesh->positions[cell[2]] - o)
                             .dot(mesh->positions[cell[3]] - o)) /
                6;
      for (std::size_t i = 0; i < 4; ++i) {
        std::array<Index, 3> face = {cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
        std::ranges::sort(face);
        EXPECT_LE(++uses[face], 2) << cage.name;
      }
    }
    const std::vector<Triangle> triangles = surface->triangles();
    const double expected = signed_volume(TriangleView{surface->positions, triangles});
    EXPECT_NEAR(volume / expected, 1, 1e-2) << cage.name;
  }
}

TEST(Delaunay, HasNoPointInsideASphere) {
  Random random(76);
  Delaunay delaunay;
  std::vector<Vec3> points;
  for (int i = 0; i < 6; ++i) { // a lattice: many points on one sphere
    for (int j = 0; j < 6; ++j) {
      for (int k = 0; k < 6; ++k) {
        points.emplace_back(0.1 * i - 0.3, 0.1 * j - 0.3, 0.1 * k - 0.3);
      }
    }
  }
  for (int i = 0; i < 100; ++i) {
    points.emplace_back(random.uniform(-0.3, 0.2), random.uniform(-0.3, 0.2), 0.05);
  }
  for (const Vec3& p : points) {
    EXPECT_TRUE(delaunay.insert(p));
  }
  double volume = 0;
  for (const Delaunay::Cell& cell : delaunay.cells()) {
    const Vec3& o = points[cell[0]];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
      edges.row(k) = (points[cell[static_cast<std::size_t>(k) + 1]] - o).transpose();
    }
    volume += std::abs(edges.determinant()) / 6;
    if (std::abs(edges.determinant()) < 1e-6) {
      continue; // flat: its sphere is anywhere
    }
    const Vec3 center = edges.partialPivLu().solve(edges.rowwise().squaredNorm() / 2);
    for (const Vec3& p : points) {
      EXPECT_GT((p - o - center).norm(), center.norm() - 1e-3);
    }
  }
  EXPECT_NEAR(volume, 0.125, 1e-3);
}

} // namespace
} // namespace cagewright
