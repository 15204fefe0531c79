#include "render/smooth_normals.h"

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

namespace cagewright {
namespace {

TEST(SmoothNormals, OfASphereAreItsPositions) {
  const TriangleMesh sphere = make_icosphere(3);
  const auto normals = smooth_normals(sphere, 45);
  for (std::size_t c = 0; c < normals.size(); ++c) {
    const Vec3& p = sphere.positions[sphere.triangles[c / 3][c % 3]];
    EXPECT_GT(normals[c].cast<double>().dot(p), 0.9995);
  }
}

TEST(SmoothNormals, OfACubeAreThoseOfItsFaces) {
  const TriangleMesh cube = make_cube();
  const auto normals = smooth_normals(cube, 45);
  for (std::size_t c = 0; c < normals.size(); ++c) {
    const Vec3 flat = triangle_normal(cube, cube.triangles[c / 3]);
    EXPECT_TRUE(normals[c].cast<double>().isApprox(flat, 1e-6));
  }
}

TEST(SmoothNormals, OfACubeWithoutCreasesPointToItsCorners) {
  const TriangleMesh cube = make_cube();
  const auto normals = smooth_normals(cube, 100);
  for (std::size_t c = 0; c < normals.size(); ++c) {
    // By angle, not by count of triangles: each of the three faces weighs the same.
    const Vec3 corner = cube.positions[cube.triangles[c / 3][c % 3]].normalized();
    EXPECT_TRUE(normals[c].cast<double>().isApprox(corner, 1e-6));
  }
}

TEST(SmoothNormals, DoNotNeedSharedVertices) {
  const TriangleMesh sphere = make_icosphere(2);
  TriangleMesh apart;
  for (const Triangle& t : sphere.triangles) {
    const auto n = static_cast<Index>(apart.positions.size());
    apart.triangles.push_back({n, n + 1, n + 2});
    for (const Index v : t) {
      apart.positions.push_back(sphere.positions[v]);
    }
  }
  const auto a = smooth_normals(sphere, 45);
  const auto b = smooth_normals(apart, 45);
  for (std::size_t c = 0; c < a.size(); ++c) {
    EXPECT_TRUE(a[c].isApprox(b[c], 1e-5F));
  }
}

TEST(SmoothNormals, KeepFacesOfOppositeSidesApart) {
  // Two triangles back to back over the same points, as in a doubled sheet.
  TriangleMesh sheet{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 1}}};
  const auto normals = smooth_normals(sheet, 45);
  EXPECT_TRUE(normals[0].isApprox(Eigen::Vector3f::UnitZ()));
  EXPECT_TRUE(normals[3].isApprox(-Eigen::Vector3f::UnitZ()));
}

TEST(SmoothNormals, AreZeroForATriangleWithoutArea) {
  TriangleMesh line{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {{0, 1, 2}}};
  for (const auto& n : smooth_normals(line, 45)) {
    EXPECT_EQ(n.norm(), 0);
  }
}

} // namespace
} // namespace cagewright
