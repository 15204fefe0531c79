/// \file
/// The connected pieces of a grid's occupied voxels.
#pragma once

#include "voxel/voxel_grid.h"

#include <cstdint>
#include <vector>

namespace cagewright {

struct GridComponents {
  int count = 0;
  std::vector<std::int32_t> labels; ///< for each voxel, of its piece in [0, count), or -1 if outer
};

/// The pieces of the occupied voxels, of which two are connected when they share a face, an edge or
/// a corner. Pieces are numbered by their first voxel in the order of the grid. Cost: O(voxels).
GridComponents grid_components(const VoxelGrid& grid);

} // namespace cagewright
