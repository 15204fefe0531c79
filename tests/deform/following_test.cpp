#include <cagewright/deform/following.h>

#include "core/rotation.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <vector>

namespace cagewright {
namespace {

/// A U of cubes, open at the top: its arms do not see each other.
PolygonMesh make_u() {
  PolygonMesh mesh;
  const std::vector<std::pair<double, double>> outline = {{0, 0}, {3, 0}, {3, 3}, {2, 3},
                                                          {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (const double y : {0.0, 1.0}) {
    for (const auto& [x, z] : outline) {
      mesh.positions.emplace_back(x, y, z);
    }
  }
  for (Index i = 0; i < 8; ++i) {
    const Index next = (i + 1) % 8;
    mesh.add_face({next, i, i + 8, next + 8});
  }
  const std::vector<std::vector<Index>> front = {{0, 1, 4, 5}, {1, 2, 3, 4}, {0, 5, 6, 7}};
  for (const std::vector<Index>& face : front) {
    mesh.add_face(face);
    mesh.add_face({face[3] + 8, face[2] + 8, face[1] + 8, face[0] + 8});
  }
  return mesh;
}

UnseenShare share_of(const PolygonMesh& cage, std::string_view kind,
                     const std::vector<Vec3>& points) {
  const auto coordinates = prepare_coordinates(cage, *CoordinateSettings::of(kind));
  EXPECT_TRUE(coordinates) << coordinates.error().message;
  const Result<UnseenShare> share = unseen_share(cage, **coordinates, points);
  EXPECT_TRUE(share);
  return *share;
}

TEST(UnseenShare, IsNothingInConvexCagesWhateverTheKind) {
  PolygonMesh cage = make_quad_cube();
  for (Vec3& p : cage.positions) {
    p = Vec3(1.1 * p.x() + 0.1 * p.z(), 0.9 * p.y(), p.z());
  }
  std::vector<Vec3> points = make_torus(0.25, 12, 6).positions;
  for (Vec3& p : points) {
    p *= 0.6;
  }
  points.push_back(cage.positions[0]);
  points.emplace_back((cage.positions[0] + cage.positions[1]) / 2);
  for (const CoordinateKind* kind : coordinate_kinds()) {
    const UnseenShare share = share_of(cage, kind->name, points);
    EXPECT_EQ(share.mean, 0) << kind->name;
    EXPECT_EQ(share.high, 0) << kind->name;
    EXPECT_GE(share.points, points.size() - 2) << kind->name;
  }
}

TEST(UnseenShare, TellsWhatPullsAcrossAGap) {
  std::vector<Vec3> left;
  for (int i = 0; i < 9; ++i) {
    left.emplace_back(0.5, 0.5, 1.3 + 0.17 * i);
  }
  const UnseenShare across = share_of(make_u(), "mean_value", left);
  EXPECT_GT(across.mean, 0.02);
  EXPECT_LT(across.mean, across.high);
  EXPECT_LT(across.high, 0.5);
  const UnseenShare seen = share_of(make_u(), "positive_mean_value", left);
  EXPECT_LT(seen.mean, 0.3 * across.mean);
}

TEST(UnseenShare, IsTheSameOnAnyNumberOfThreads) {
  const std::vector<Vec3> points(100, Vec3(0.4, 0.6, 2.2));
  const auto with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return share_of(make_u(), "mean_value", points).mean; });
  };
  EXPECT_EQ(with(1), with(4));
}

TEST(DeformedFigures, SeeNothingInRigidMotions) {
  const TriangleMesh mesh = make_torus(0.4, 16, 8);
  std::vector<Vec3> posed;
  for (const Vec3& p : mesh.positions) {
    posed.emplace_back(rotation_about(Vec3(1, 2, 3).normalized(), 1.1) * p + Vec3(1, 0, -2));
  }
  const DeformedFigures figures = deformed_figures(mesh, posed);
  EXPECT_NEAR(figures.mean_stretch, 1, 1e-7);
  EXPECT_NEAR(figures.max_stretch, 1, 1e-7);
  EXPECT_NEAR(figures.volume_change, 0, 1e-12);
  EXPECT_EQ(figures.flipped, 0U);
}

TEST(DeformedFigures, MeasureStretchEitherWayAndVolume) {
  const TriangleMesh cube = make_cube();
  for (const double factor : {2.0, 0.5}) {
    std::vector<Vec3> posed = cube.positions;
    for (Vec3& p : posed) {
      p.x() *= factor;
    }
    const DeformedFigures figures = deformed_figures(cube, posed);
    EXPECT_NEAR(figures.max_stretch, 2, 1e-12);
    EXPECT_NEAR(figures.high_stretch, 2, 1e-12);
    EXPECT_NEAR(figures.mean_stretch, (4 * 2.0 + 2 * 1.0) / 6, 1e-7); // two faces keep their shape
    EXPECT_NEAR(figures.volume_change, factor - 1, 1e-12);
    EXPECT_EQ(figures.flipped, 0U);
  }
}

TEST(DeformedFigures, CountTrianglesThatFoldOver) {
  TriangleMesh plane;
  for (int i = 0; i < 25; ++i) {
    plane.positions.emplace_back(i % 5, i / 5, 0);
  }
  for (Index y = 0; y < 4; ++y) {
    for (Index x = 0; x < 4; ++x) {
      const Index corner = 5 * y + x;
      plane.triangles.push_back({corner, corner + 1, corner + 6});
      plane.triangles.push_back({corner, corner + 6, corner + 5});
    }
  }
  std::vector<Vec3> posed = plane.positions;
  posed[12] = Vec3(3.2, 2.1, 0); // past its neighbor
  const DeformedFigures figures = deformed_figures(plane, posed);
  EXPECT_GT(figures.flipped, 0U);
  EXPECT_LT(figures.flipped, 4U);
  posed[12] = posed[13];
  EXPECT_TRUE(std::isinf(deformed_figures(plane, posed).max_stretch));
}

TEST(DeformedFigures, CountTrianglesThatHaveComeToTouchOthers) {
  const TriangleMesh apart = joined(make_icosphere(1), [] {
    TriangleMesh other = make_icosphere(1);
    for (Vec3& p : other.positions) {
      p.x() += 3;
    }
    return other;
  }());
  std::vector<Vec3> posed = apart.positions;
  EXPECT_EQ(deformed_figures(apart, posed).in_contact, 0U);
  for (std::size_t i = posed.size() / 2; i < posed.size(); ++i) {
    posed[i].x() -= 1.5; // into the other
  }
  const std::size_t in_contact = deformed_figures(apart, posed).in_contact;
  EXPECT_GT(in_contact, 10U);
  EXPECT_LT(in_contact, 80U);
  // What touches at rest is no news.
  TriangleMesh together = apart;
  together.positions = posed;
  EXPECT_EQ(deformed_figures(together, apart.positions).in_contact, 0U);
  EXPECT_EQ(deformed_figures(together, posed).in_contact, 0U);
}

} // namespace
} // namespace cagewright
