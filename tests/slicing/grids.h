#pragma once

#include "voxel/voxel_grid.h"

#include <functional>
#include <numeric>
#include <vector>

namespace cagewright::test {

/// A grid along the world's axes with unit voxels, occupied where the predicate says so of a
/// voxel's center; an empty layer surrounds it.
inline VoxelGrid grid_where(std::array<int, 3> size,
                            const std::function<bool(const Vec3&)>& inside) {
  VoxelGrid grid;
  grid.axes = Mat3::Identity();
  grid.origin = Vec3(-1, -1, -1);
  grid.size = 1;
  grid.dims = {size[0] + 2, size[1] + 2, size[2] + 2};
  grid.kinds.assign(static_cast<std::size_t>(grid.dims[0]) *
                        static_cast<std::size_t>(grid.dims[1]) *
                        static_cast<std::size_t>(grid.dims[2]),
                    VoxelKind::outer);
  for (int k = 1; k <= size[2]; ++k) {
    for (int j = 1; j <= size[1]; ++j) {
      for (int i = 1; i <= size[0]; ++i) {
        if (inside(grid.center(i, j, k))) {
          grid.kinds[grid.index(i, j, k)] = VoxelKind::inner;
        }
      }
    }
  }
  return grid;
}

inline std::vector<std::uint32_t> occupied_voxels(const VoxelGrid& grid) {
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t v = 0; v < grid.kinds.size(); ++v) {
    if (grid.occupied(v)) {
      voxels.push_back(v);
    }
  }
  return voxels;
}

/// The least and the greatest corner of the voxels with these centers' coordinates: [low, high).
inline bool between(const Vec3& p, const Vec3& low, const Vec3& high) {
  return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
}

} // namespace cagewright::test
