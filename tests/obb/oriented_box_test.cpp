#include "obb/oriented_box.h"

#include "mesh/shapes.h"
#include "obb/test_points.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

namespace cagewright {
namespace {

OrientedBox tilted_box() {
  return {{1, 2, 3}, test::rotation(7), {3, 1, 2}};
}

TEST(OrientedBox, HasTheCornersOfACubeInTheSameOrder) {
  const OrientedBox box{Vec3::Zero(), Mat3::Identity(), Vec3::Ones()};
  const TriangleMesh cube = make_cube();
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(box.corners()[i], cube.positions[i]);
  }
}

TEST(OrientedBox, AsAMeshIsOutwardAndHasItsVolume) {
  EXPECT_NEAR(signed_volume(to_mesh(tilted_box())), tilted_box().volume(), 1e-12);
  EXPECT_DOUBLE_EQ(tilted_box().volume(), 48);
}

TEST(OrientedBox, ContainsItsCornersAndNothingBeyondThem) {
  const OrientedBox box = tilted_box();
  for (const Vec3& corner : box.corners()) {
    EXPECT_TRUE(box.contains(corner, 1e-12));
    const Vec3 beyond = corner + 0.01 * (corner - box.center);
    EXPECT_FALSE(box.contains(beyond, 1e-12));
    EXPECT_TRUE(box.padded(0.1).contains(beyond));
    EXPECT_TRUE(box.contains(beyond, 0.1));
  }
}

TEST(OrientedBox, PaddedGrowsOnEverySide) {
  EXPECT_EQ(tilted_box().padded(0.5).half, Vec3(3.5, 1.5, 2.5));
}

TEST(BoxInFrame, FindsABoxAgainFromItsCorners) {
  const OrientedBox box = tilted_box();
  const auto corners = box.corners();
  const OrientedBox found = box_in_frame(box.axes, corners);
  EXPECT_LT((found.center - box.center).norm(), 1e-14);
  EXPECT_LT((found.half - box.half).norm(), 1e-14);
}

TEST(BoxInFrame, IsTightFarFromTheOrigin) {
  OrientedBox box = tilted_box();
  box.center = {1e6, -1e6, 1e6};
  const auto corners = box.corners();
  EXPECT_LT((box_in_frame(box.axes, corners).half - box.half).norm(), 1e-9);
}

TEST(BoxInFrame, OfNoPointsHasNoExtent) {
  EXPECT_EQ(box_in_frame(test::rotation(1), {}).volume(), 0);
  EXPECT_EQ(box_in_frame(test::rotation(1), {}).center, Vec3::Zero());
}

TEST(SortedByLength, PutsTheLongestAxisFirstAndIsTheSameBox) {
  const OrientedBox box = tilted_box();
  const OrientedBox sorted = sorted_by_length(box);
  EXPECT_EQ(sorted.half, Vec3(3, 2, 1));
  EXPECT_GT(sorted.axes.determinant(), 0.999);
  for (const Vec3& corner : sorted.corners()) {
    EXPECT_TRUE(box.contains(corner, 1e-12));
  }
}

TEST(SortedByLength, KeepsTheOrderOfEqualAxes) {
  const OrientedBox box{Vec3::Zero(), test::rotation(3), {1, 2, 2}};
  const OrientedBox sorted = sorted_by_length(box);
  EXPECT_EQ(Vec3(sorted.axes.col(0)), Vec3(box.axes.col(1)));
  EXPECT_EQ(Vec3(sorted.axes.col(1)), Vec3(box.axes.col(2)));
}

} // namespace
} // namespace cagewright
