#include "envelope/closing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// Adds to the set every voxel whose center is within `reach` voxels of the center of one in it.
void grow(std::vector<std::uint8_t>& set, const std::array<int, 3>& dims, double reach) {
  const auto nx = static_cast<std::size_t>(dims[0]);
  const auto ny = static_cast<std::size_t>(dims[1]);
  const auto nz = static_cast<std::size_t>(dims[2]);
  // Separable squared distance, cut off at the reach: along x, then y, then z.
  const int r = static_cast<int>(std::floor(reach));
  const double far = reach * reach + 1;
  std::vector<double> squared(set.size(), far);
  for (std::size_t i = 0; i < set.size(); ++i) {
    squared[i] = set[i] != 0 ? 0 : far;
  }
  const std::array<std::size_t, 3> counts = {nx, ny, nz};
  const std::array<std::size_t, 3> strides = {1, nx, nx * ny};
  for (int k = 0; k < 3; ++k) {
    std::vector<double> next(set.size(), far);
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto at = static_cast<int>(i / strides[k] % counts[k]);
      const int low = std::max(0, at - r);
      const int high = std::min(static_cast<int>(counts[k]) - 1, at + r);
      for (int j = low; j <= high; ++j) {
        const double d = squared[i + strides[k] * static_cast<std::size_t>(j) -
                                 strides[k] * static_cast<std::size_t>(at)] +
                         (j - at) * (j - at);
        next[i] = std::min(next[i], d);
      }
    }
    squared = std::move(next);
  }
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = squared[i] <= reach * reach ? 1 : 0;
  }
}

} // namespace

VoxelGrid padded(const VoxelGrid& grid, int layers) {
  VoxelGrid wide = grid;
  for (int& d : wide.dims) {
    d += 2 * layers;
  }
  wide.origin = grid.corner(-layers, -layers, -layers);
  wide.kinds.assign(wide.index(0, 0, wide.dims[2]), VoxelKind::outer);
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const auto [x, y, z] = grid.cell(i);
    wide.kinds[wide.index(x + layers, y + layers, z + layers)] = grid.kinds[i];
  }
  return wide;
}

int layers_to_close(double radius) {
  return static_cast<int>(std::ceil(radius)) + 1;
}

void close_gaps(VoxelGrid& grid, double radius) {
  std::vector<std::uint8_t> set(grid.kinds.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = grid.occupied(i) ? 1 : 0;
  }
  grow(set, grid.dims, radius);
  for (std::uint8_t& s : set) {
    s = s == 0 ? 1 : 0;
  }
  grow(set, grid.dims, radius);
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == 0 && !grid.occupied(i)) {
      grid.kinds[i] = VoxelKind::inner;
    }
  }
}

} // namespace cagewright
