#include "slicing/cross_section.h"

#include "grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace cagewright {
namespace {

using test::between;
using test::grid_where;

VoxelOwners all_in_one_part(const VoxelGrid& grid) {
  VoxelOwners owners{std::vector<std::uint32_t>(grid.kinds.size(), VoxelOwners::none),
                     std::vector<std::uint32_t>(grid.kinds.size(), 0)};
  owners.assign(test::occupied_voxels(grid), 0);
  return owners;
}

/// A head (10 x 8 x 8) on a neck (6 x 2 x 2) on a trunk (16 x 8 x 8), along x.
VoxelGrid dumb_bell() {
  return grid_where({32, 8, 8}, [](const Vec3& p) {
    return p.x() < 16 || p.x() >= 22 || between(p, {16, 3, 3}, {22, 5, 5});
  });
}

TEST(CrossSection, IsTheAreaOfEachSlice) {
  const VoxelGrid grid = dumb_bell();
  const OrientedBox box{{16, 4, 4}, Mat3::Identity(), {16, 4, 4}};
  const CrossSection f = cross_section(grid, all_in_one_part(grid), 0, box, 0);
  ASSERT_EQ(f.area.size(), 32U);
  for (std::size_t k = 0; k < 32; ++k) {
    EXPECT_DOUBLE_EQ(f.area[k], k >= 16 && k < 22 ? 4 : 64) << k;
  }
  EXPECT_DOUBLE_EQ(f.between(15), 0);
}

TEST(CrossSection, IsTheSmallestOfTwoLegs) {
  const VoxelGrid grid = grid_where({20, 12, 6}, [](const Vec3& p) {
    return p.x() >= 10 || p.y() < 5 || p.y() >= 9; // legs of 5 and 3 voxels, side by side
  });
  const OrientedBox box{{10, 6, 3}, Mat3::Identity(), {10, 6, 3}};
  const CrossSection f = cross_section(grid, all_in_one_part(grid), 0, box, 0);
  EXPECT_DOUBLE_EQ(f.area[4], 3 * 6);
  EXPECT_DOUBLE_EQ(f.area[15], 12 * 6);
}

TEST(CrossSection, IgnoresSpecks) {
  const VoxelGrid grid = grid_where({10, 12, 12}, [](const Vec3& p) {
    return p.y() < 8 || between(p, {4, 10, 10}, {5, 11, 11});
  });
  const OrientedBox box{{5, 6, 6}, Mat3::Identity(), {5, 6, 6}};
  const CrossSection f = cross_section(grid, all_in_one_part(grid), 0, box, 0);
  EXPECT_DOUBLE_EQ(f.area[4], 96);
}

TEST(CrossSection, IsSmoothInATurnedFrame) {
  const VoxelGrid grid = grid_where({60, 60, 30}, [](const Vec3& p) {
    const Vec3 axis = Vec3(1, 1, 0).normalized();
    const Vec3 d = p - Vec3(30, 30, 15);
    return std::abs(d.dot(axis)) < 28 && (d - d.dot(axis) * axis).norm() < 9;
  });
  Mat3 turned = Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitZ()).toRotationMatrix();
  const OrientedBox box{{30, 30, 15}, turned, {28, 10, 10}};
  const CrossSection f = cross_section(grid, all_in_one_part(grid), 0, box, 0);
  const double disc = std::numbers::pi * 81;
  for (std::size_t k = 3; k + 3 < f.area.size(); ++k) {
    EXPECT_NEAR(f.area[k], disc, 0.08 * disc) << k;
  }
}

TEST(GreatestJump, IsWhereTheNeckMeetsTheTrunk) {
  std::vector<double> f(32, 64);
  std::fill(f.begin() + 16, f.begin() + 22, 4.0);
  f[3] = 60; // a dent
  const Jump jump = greatest_jump(f, 2);
  EXPECT_EQ(jump.slice, 15U);
  EXPECT_DOUBLE_EQ(jump.height, 60.0 / 64);
}

TEST(GreatestJump, SumsASlopeFromItsFootToItsTop) {
  const std::vector<double> f = {10, 10, 10, 11, 13, 18, 20, 20, 20, 12, 20, 20};
  const Jump jump = greatest_jump(f, 1);
  EXPECT_EQ(jump.slice, 4U);
  EXPECT_DOUBLE_EQ(jump.height, 0.5);
}

TEST(GreatestJump, KeepsAwayFromTheEnds) {
  const std::vector<double> f = {1, 20, 20, 20, 20, 20, 20, 20, 20, 18, 17, 20, 20, 20, 3};
  EXPECT_EQ(greatest_jump(f, 3).slice, 8U);
  EXPECT_EQ(greatest_jump(f, 1).slice, 0U);
}

TEST(GreatestJump, IsNothingOnAFlatOrEmptyFunction) {
  EXPECT_EQ(greatest_jump({}, 2).height, 0);
  EXPECT_EQ(greatest_jump(std::vector<double>(9, 5.0), 2).height, 0);
  EXPECT_EQ(greatest_jump(std::vector<double>(9, 0.0), 2).height, 0);
}

} // namespace
} // namespace cagewright
