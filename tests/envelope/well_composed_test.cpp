#include "envelope/well_composed.h"

#include "core/random.h"
#include "voxel/voxel_mesh.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright {
namespace {

VoxelGrid empty_grid(int size) {
  VoxelGrid grid;
  grid.dims = {size, size, size};
  grid.kinds.assign(grid.index(0, 0, size), VoxelKind::outer);
  return grid;
}

bool on_border(const VoxelGrid& grid, std::size_t i) {
  const std::array<int, 3> c = grid.cell(i);
  return std::any_of(c.begin(), c.end(), [&](int x) { return x == 0 || x + 1 == grid.dims[0]; });
}

void mark_all_as_feature(VoxelGrid& grid) {
  for (VoxelKind& kind : grid.kinds) {
    kind = kind == VoxelKind::outer ? kind : VoxelKind::feature;
  }
}

TEST(WellComposed, VoxelsHaveAManifoldSurfaceWhateverTheyWere) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    VoxelGrid grid = empty_grid(9);
    const double share = random.uniform(0.05, 0.6);
    for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
      // Two layers stay empty, so that repairs do not reach the border.
      const std::array<int, 3> c = grid.cell(i);
      const bool inner = std::all_of(c.begin(), c.end(), [](int x) { return x >= 2 && x < 7; });
      if (inner && random.uniform() < share) {
        grid.kinds[i] = VoxelKind::feature;
      }
    }
    const VoxelGrid before = grid;
    do {
      make_well_composed(grid);
    } while (fill_cavities(grid) > 0);
    for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
      EXPECT_TRUE(grid.occupied(i) || !before.occupied(i));
      EXPECT_FALSE(grid.occupied(i) && on_border(grid, i));
    }
    mark_all_as_feature(grid);
    const TriangleMesh surface = to_triangle_mesh(voxel_boxes(grid, {VoxelKind::feature}));
    EXPECT_TRUE(surface.triangles.empty() || is_embedded(surface)) << "seed " << seed;
  }
}

TEST(WellComposed, LeavesAlonePartsThatAreWellComposed) {
  VoxelGrid grid = empty_grid(6);
  grid.kinds[grid.index(2, 2, 2)] = VoxelKind::feature;
  grid.kinds[grid.index(3, 2, 2)] = VoxelKind::feature;
  grid.kinds[grid.index(3, 3, 2)] = VoxelKind::feature;
  EXPECT_EQ(make_well_composed(grid), 0);
}

TEST(WellComposed, JoinsVoxelsThatShareAnEdgeOnly) {
  VoxelGrid grid = empty_grid(6);
  grid.kinds[grid.index(2, 2, 2)] = VoxelKind::feature;
  grid.kinds[grid.index(3, 3, 2)] = VoxelKind::feature;
  EXPECT_EQ(make_well_composed(grid), 1);
}

TEST(FillCavities, FillsWhatTheOutsideDoesNotReach) {
  VoxelGrid grid = empty_grid(7);
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const std::array<int, 3> c = grid.cell(i);
    if (std::all_of(c.begin(), c.end(), [](int x) { return x >= 2 && x < 5; })) {
      grid.kinds[i] = VoxelKind::feature;
    }
  }
  grid.kinds[grid.index(3, 3, 3)] = VoxelKind::outer;
  EXPECT_EQ(fill_cavities(grid), 1);
  grid.kinds[grid.index(3, 3, 3)] = VoxelKind::outer;
  grid.kinds[grid.index(3, 3, 2)] = VoxelKind::outer; // a way in
  EXPECT_EQ(fill_cavities(grid), 0);
}

} // namespace
} // namespace cagewright
