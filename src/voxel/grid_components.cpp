#include "voxel/grid_components.h"

#include <algorithm>

namespace cagewright {

GridComponents grid_components(const VoxelGrid& grid) {
  GridComponents result{0, std::vector<std::int32_t>(grid.kinds.size(), -1)};
  std::vector<std::size_t> stack;
  const auto take = [&](std::size_t i) {
    if (grid.occupied(i) && result.labels[i] < 0) {
      result.labels[i] = result.count;
      stack.push_back(i);
    }
  };
  for (std::size_t seed = 0; seed < grid.kinds.size(); ++seed) {
    take(seed);
    if (stack.empty()) {
      continue;
    }
    while (!stack.empty()) {
      const std::array<int, 3> c = grid.cell(stack.back());
      stack.pop_back();
      for (int k = std::max(c[2] - 1, 0); k <= std::min(c[2] + 1, grid.dims[2] - 1); ++k) {
        for (int j = std::max(c[1] - 1, 0); j <= std::min(c[1] + 1, grid.dims[1] - 1); ++j) {
          for (int i = std::max(c[0] - 1, 0); i <= std::min(c[0] + 1, grid.dims[0] - 1); ++i) {
            take(grid.index(i, j, k));
          }
        }
      }
    }
    ++result.count;
  }
  return result;
}

} // namespace cagewright
