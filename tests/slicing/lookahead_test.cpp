#include "slicing/lookahead.h"

#include "grids.h"
#include "slicing/tight_box.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright {
namespace {

using test::between;
using test::grid_where;
using test::occupied_voxels;

/// A square ring, 30 voxels wide.
bool in_ring(const Vec3& p) {
  return between(p, Vec3(0, 0, 0), Vec3(30, 30, 8)) && !between(p, Vec3(6, 6, 0), Vec3(24, 24, 8));
}

/// What a cut of the ring leaves when each part is cut once more, for a plane at each axis' offset.
std::vector<double> shares_left(const VoxelGrid& grid, const std::vector<std::uint32_t>& voxels) {
  const OrientedBox box = tight_box(grid, voxels, BoxFit::aligned, grid.axes, 0);
  const Lookahead lookahead(grid, voxels, box, true, 0);
  std::vector<double> shares;
  for (const CutPlane& plane : lookahead.evenly_spaced_planes(2)) {
    shares.push_back(lookahead.share_left(plane));
  }
  return shares;
}

// No single cut of a ring saves much; two open its hole.
TEST(Lookahead, SeesThatHalvesOfARingCanBeCutAgain) {
  const VoxelGrid ring = grid_where({30, 30, 8}, in_ring);
  const std::vector<double> shares = shares_left(ring, occupied_voxels(ring));
  ASSERT_FALSE(shares.empty());
  EXPECT_LT(*std::min_element(shares.begin(), shares.end()), 0.8);
  EXPECT_GT(*std::min_element(shares.begin(), shares.end()), 0.3); // the ring fills 64 % of its box
}

// Only the part itself is looked at, wherever it lies in whatever grid.
TEST(Lookahead, JudgesAPartOfALargeGridLikeTheSamePartAlone) {
  const VoxelGrid alone = grid_where({30, 30, 8}, in_ring);
  const Vec3 moved(24, 12, 36); // whole coarse cells, as many fine ones as they may have on a side
  const VoxelGrid large = grid_where({90, 80, 60}, [&](const Vec3& p) {
    return in_ring(p - moved) || between(p, Vec3(0, 60, 0), Vec3(90, 80, 60));
  });
  std::vector<std::uint32_t> part;
  for (const std::uint32_t v : occupied_voxels(large)) {
    if (in_ring(large.center(v) - moved)) {
      part.push_back(v);
    }
  }
  const std::vector<double> expected = shares_left(alone, occupied_voxels(alone));
  const std::vector<double> shares = shares_left(large, part);
  ASSERT_EQ(shares.size(), expected.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    EXPECT_NEAR(shares[i], expected[i], 1e-12) << i;
  }
}

} // namespace
} // namespace cagewright
