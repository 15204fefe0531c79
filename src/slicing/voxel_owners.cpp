#include "slicing/voxel_owners.h"

namespace cagewright {

std::array<std::ptrdiff_t, 26> neighbor_steps(const VoxelGrid& grid) {
  std::array<std::ptrdiff_t, 26> steps{};
  const std::ptrdiff_t row = grid.dims[0];
  const std::ptrdiff_t layer = row * grid.dims[1];
  std::size_t count = 0;
  for (const std::ptrdiff_t k : {-1, 0, 1}) {
    for (const std::ptrdiff_t j : {-1, 0, 1}) {
      for (const std::ptrdiff_t i : {-1, 0, 1}) {
        if (i != 0 || j != 0 || k != 0) {
          steps[count++] = i + row * j + layer * k;
        }
      }
    }
  }
  return steps;
}

void VoxelOwners::assign(std::span<const std::uint32_t> voxels, std::uint32_t label) {
  for (std::uint32_t s = 0; s < voxels.size(); ++s) {
    part[voxels[s]] = label;
    slot[voxels[s]] = s;
  }
}

} // namespace cagewright
