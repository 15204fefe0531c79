/// \file
/// Several pieces made one.
#pragma once

#include "voxel/voxel_grid.h"

namespace cagewright {

/// Marks further voxels as feature until the occupied ones are a single piece (in the sense of
/// grid_components), and returns the number of bridges: pieces - 1, or 0 for none.
///
/// Bridges are the edges of a minimum spanning tree of the pieces, where the distance of two pieces
/// is that of their nearest voxels in steps from face to face. Each is the straight line of voxels
/// between two such, so none leaves the box of the occupied voxels.
/// Cost: O(N + E log E) for N voxels, of which E lie half-way between two pieces.
int join_pieces(VoxelGrid& grid);

} // namespace cagewright
