// Of what is done with a grid of voxels once it is made.
#include "obb/principal_axes.h"
#include "voxel/bridge.h"
#include "voxel/grid_components.h"
#include "voxel/point_set.h"
#include "voxel/test_meshes.h"
#include "voxel/voxel_mesh.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <map>

namespace cagewright {
namespace {

VoxelGrid empty_grid(const std::array<int, 3>& dims) {
  VoxelGrid grid;
  grid.axes = test::rotation(1);
  grid.origin = {1, 2, 3};
  grid.size = 0.5;
  grid.dims = dims;
  grid.kinds.assign(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2], VoxelKind::outer);
  return grid;
}

VoxelGrid scattered(const std::array<int, 3>& dims, int count, std::uint64_t seed) {
  VoxelGrid grid = empty_grid(dims);
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const auto pick = [&](int n) { return 1 + static_cast<int>(random.below(n - 2)); };
    const int x = pick(dims[0]);
    const int y = pick(dims[1]);
    const int z = pick(dims[2]);
    grid.kinds[grid.index(x, y, z)] = i % 3 == 0 ? VoxelKind::inner : VoxelKind::feature;
  }
  return grid;
}

TEST(VoxelGrid, NumbersItsCellsThereAndBack) {
  const VoxelGrid grid = empty_grid({3, 4, 5});
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    EXPECT_EQ(grid.index(grid.cell(i)), i);
  }
  EXPECT_EQ(grid.index(1, 2, 3) + grid.stride(2), grid.index(1, 2, 4));
  EXPECT_EQ(grid.index(1, 2, 3) + grid.stride(1), grid.index(1, 3, 3));
  EXPECT_EQ(grid.index(1, 2, 3) + grid.stride(0), grid.index(2, 2, 3));
}

TEST(VoxelGrid, MapsToTheWorldAndBack) {
  const VoxelGrid grid = empty_grid({3, 4, 5});
  EXPECT_LT((grid.to_grid(grid.center(1, 2, 3)) - Vec3(1.5, 2.5, 3.5)).norm(), 1e-13);
  EXPECT_EQ(grid.center(grid.index(1, 2, 3)), grid.center(1, 2, 3));
  EXPECT_EQ(grid.corner(0, 0, 0), grid.origin);
  EXPECT_NEAR((grid.corner(1, 2, 3) - grid.corner(1, 2, 4)).norm(), grid.size, 1e-14);
}

TEST(PointSet, HoldsVerticesThenInnerThenFeatureCenters) {
  const TriangleMesh cube = make_cube();
  const auto grid = voxelize(cube, pca_box(cube.positions), {.resolution = 9});
  ASSERT_TRUE(grid);
  const std::vector<Vec3> points = point_set(cube, *grid);
  const std::size_t inner = grid->count(VoxelKind::inner);
  EXPECT_EQ(inner, 7U * 7 * 7);
  ASSERT_EQ(points.size(), 8 + 9U * 9 * 9);
  EXPECT_EQ(points[3], cube.positions[3]);
  for (std::size_t i = 8; i < points.size(); ++i) {
    EXPECT_EQ(points[i].cwiseAbs().maxCoeff() < 0.9, i < 8 + inner);
  }
}

TEST(GridComponents, AreJoinedAtFacesEdgesAndCorners) {
  VoxelGrid grid = empty_grid({9, 9, 9});
  for (const auto& c :
       {std::array{1, 1, 1}, {2, 2, 2}, {3, 2, 2}, {3, 3, 2}, {7, 7, 7}, {7, 5, 7}}) {
    grid.kinds[grid.index(c)] = VoxelKind::feature;
  }
  const GridComponents pieces = grid_components(grid);
  EXPECT_EQ(pieces.count, 3);
  EXPECT_EQ(pieces.labels[grid.index(1, 1, 1)], 0);
  EXPECT_EQ(pieces.labels[grid.index(3, 3, 2)], 0);
  EXPECT_EQ(pieces.labels[grid.index(7, 5, 7)], 1);
  EXPECT_EQ(pieces.labels[grid.index(7, 7, 7)], 2);
  EXPECT_EQ(pieces.labels[0], -1);
}

TEST(GridComponents, OfAnEmptyGridAreNone) {
  EXPECT_EQ(grid_components(empty_grid({3, 3, 3})).count, 0);
}

// Voxels that Prim's algorithm over all pairs of voxels would add.
std::size_t least_bridging(const VoxelGrid& grid) {
  std::vector<std::array<int, 3>> cells;
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    if (grid.occupied(i)) {
      cells.push_back(grid.cell(i));
    }
  }
  const auto steps = [](const auto& a, const auto& b) {
    int sum = 0;
    int most = 0;
    for (int k = 0; k < 3; ++k) {
      sum += std::abs(a[k] - b[k]);
      most = std::max(most, std::abs(a[k] - b[k]));
    }
    return most <= 1 ? 0 : sum - 1; // neighbours need no bridge
  };
  std::vector<int> distance(cells.size(), 1 << 20);
  std::vector<bool> joined(cells.size(), false);
  distance[0] = 0;
  std::size_t total = 0;
  for (std::size_t n = 0; n < cells.size(); ++n) {
    std::size_t next = cells.size();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!joined[i] && (next == cells.size() || distance[i] < distance[next])) {
        next = i;
      }
    }
    joined[next] = true;
    total += static_cast<std::size_t>(distance[next]);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      distance[i] = std::min(distance[i], steps(cells[i], cells[next]));
    }
  }
  return total;
}

TEST(JoinPieces, MakesOnePieceWithTheLeastBridges) {
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    VoxelGrid grid = scattered({20, 16, 12}, 2 + 5 * static_cast<int>(seed), seed);
    const VoxelGrid before = grid;
    const int pieces = grid_components(grid).count;
    const std::size_t outer = grid.count(VoxelKind::outer);
    EXPECT_EQ(join_pieces(grid), pieces - 1);
    EXPECT_EQ(grid_components(grid).count, 1);
    EXPECT_LE(outer - grid.count(VoxelKind::outer), least_bridging(before)) << seed;
    for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
      if (before.occupied(i)) {
        EXPECT_EQ(grid.kinds[i], before.kinds[i]);
      }
    }
  }
}

TEST(JoinPieces, LeavesTheOutermostLayerOuter) {
  VoxelGrid grid = scattered({16, 16, 16}, 30, 7);
  join_pieces(grid);
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const auto c = grid.cell(i);
    if (*std::min_element(c.begin(), c.end()) == 0 || *std::max_element(c.begin(), c.end()) == 15) {
      EXPECT_FALSE(grid.occupied(i));
    }
  }
}

TEST(JoinPieces, DoesNothingToOnePieceOrNone) {
  VoxelGrid grid = empty_grid({5, 5, 5});
  EXPECT_EQ(join_pieces(grid), 0);
  grid.kinds[grid.index(2, 2, 2)] = VoxelKind::inner;
  EXPECT_EQ(join_pieces(grid), 0);
  EXPECT_EQ(grid.count(VoxelKind::outer), 124U);
}

TEST(JoinPieces, CopesWithThousandsOfPieces) {
  VoxelGrid grid = empty_grid({60, 60, 60});
  int pieces = 0;
  for (int z = 1; z < 59; z += 3) {
    for (int y = 1; y < 59; y += 3) {
      for (int x = 1; x < 59; x += 3) {
        grid.kinds[grid.index(x, y, z)] = VoxelKind::feature;
        ++pieces;
      }
    }
  }
  EXPECT_EQ(join_pieces(grid), pieces - 1);
  EXPECT_EQ(grid_components(grid).count, 1);
  EXPECT_EQ(grid.kinds.size() - grid.count(VoxelKind::outer),
            static_cast<std::size_t>(pieces + 2 * (pieces - 1)));
}

// How often each edge is walked from its lesser to its greater vertex, less the other way.
std::map<std::pair<Index, Index>, int> edge_balance(const PolygonMesh& mesh) {
  std::map<std::pair<Index, Index>, int> balance;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Index a = face[i];
      const Index b = face[(i + 1) % face.size()];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return balance;
}

TEST(VoxelBoxes, EncloseTheVolumeOfTheirKind) {
  const VoxelGrid grid = scattered({12, 12, 12}, 300, 5);
  for (const VoxelKind kind : {VoxelKind::inner, VoxelKind::feature}) {
    const PolygonMesh mesh = voxel_boxes(grid, {kind});
    const double voxel = grid.size * grid.size * grid.size;
    EXPECT_NEAR(signed_volume(to_triangle_mesh(mesh)) / voxel,
                static_cast<double>(grid.count(kind)), 1e-9);
    for (const auto& [edge, balance] : edge_balance(mesh)) {
      EXPECT_EQ(balance, 0);
    }
  }
}

TEST(VoxelBoxes, NameTheirKindsAndShareVertices) {
  VoxelGrid grid = empty_grid({5, 5, 5});
  grid.kinds[grid.index(2, 2, 2)] = VoxelKind::inner;
  grid.kinds[grid.index(3, 2, 2)] = VoxelKind::feature;
  const PolygonMesh mesh = voxel_boxes(grid);
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"feature", "inner"}));
  EXPECT_EQ(mesh.face_count(), 12U);
  EXPECT_EQ(mesh.positions.size(), 12U);
  ASSERT_EQ(mesh.face_groups.size(), 12U);
  EXPECT_EQ(mesh.face_groups[5], 0U);
  EXPECT_EQ(mesh.face_groups[6], 1U);
  EXPECT_EQ(voxel_boxes(grid, {VoxelKind::inner}).face_count(), 6U);
}

} // namespace
} // namespace cagewright
