/// \file
/// Which part of a box tree every voxel is in.
#pragma once

#include "voxel/voxel_grid.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// The 26 steps from a voxel to its neighbours, as differences of indices. The outermost layer of
/// a grid is never occupied, so from an occupied voxel none of them leaves the array.
std::array<std::ptrdiff_t, 26> neighbor_steps(const VoxelGrid& grid);

/// Which part of the tree every voxel is in now, and where it stands in that part's list.
/// Each part writes only the entries of its own voxels: parts can be worked on in parallel.
struct VoxelOwners {
  static constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> part; ///< one label for each voxel of the grid
  std::vector<std::uint32_t> slot; ///< its position in the list of the part

  void assign(std::span<const std::uint32_t> voxels, std::uint32_t label);
};

} // namespace cagewright
