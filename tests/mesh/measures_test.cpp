#include <cagewright/mesh/measures.h>

#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

TEST(SignedVolume, IsExactOnACubeAnywhere) {
  TriangleMesh cube = make_cube();
  EXPECT_DOUBLE_EQ(signed_volume(cube), 8);
  for (Vec3& p : cube.positions) {
    p += Vec3(1e6, -1e6, 1e6);
  }
  EXPECT_DOUBLE_EQ(signed_volume(cube), 8);
}

TEST(SignedVolume, IsNegativeWhenInverted) {
  TriangleMesh sphere = make_icosphere(3);
  for (Triangle& t : sphere.triangles) {
    std::swap(t[0], t[1]);
  }
  EXPECT_NEAR(signed_volume(sphere), -4 * std::numbers::pi / 3, 0.05);
}

TEST(SignedVolume, OfAllShapesIsPositive) {
  EXPECT_DOUBLE_EQ(signed_volume(make_tetrahedron()), 8.0 / 3);
  EXPECT_GT(signed_volume(make_icosphere(0)), 2.5);
  EXPECT_NEAR(signed_volume(make_torus(0.3, 90, 60)),
              2 * std::numbers::pi * std::numbers::pi * 0.09, 0.01);
}

TEST(SurfaceArea, OfACubeIs24) {
  EXPECT_DOUBLE_EQ(surface_area(make_cube()), 24);
}

TEST(BoundingBox, IgnoresVerticesThatNoTriangleUses) {
  TriangleMesh cube = make_cube();
  cube.positions.emplace_back(100, 0, 0);
  EXPECT_EQ(bounding_box(TriangleView(cube)).max().x(), 1);
  EXPECT_EQ(bounding_box(std::span<const Vec3>(cube.positions)).max().x(), 100);
}

TEST(TriangleQuality, IsOneWhenEquilateralAndZeroWhenDegenerate) {
  const double h = std::sqrt(3.0) / 2;
  EXPECT_NEAR(triangle_quality({0, 0, 0}, {1, 0, 0}, {0.5, h, 0}), 1, 1e-15);
  EXPECT_EQ(triangle_quality({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0);
  EXPECT_EQ(triangle_quality({0, 0, 0}, {0, 0, 0}, {2, 0, 0}), 0);
  EXPECT_NEAR(triangle_quality({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 2 * std::sqrt(2.0) - 2, 1e-15);
}

} // namespace
} // namespace cagewright
