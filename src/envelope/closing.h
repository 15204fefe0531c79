/// \file
/// Gaps of a grid of voxels filled.
#pragma once

#include "voxel/voxel_grid.h"

namespace cagewright {

/// The grid with `layers` more outer voxels on every side.
VoxelGrid padded(const VoxelGrid& grid, int layers);

/// How many layers close_gaps() needs round what is occupied.
int layers_to_close(double radius);

/// Morphological closing: makes inner what a ball of that radius (in voxels) cannot enter from
/// outside. The outermost layers_to_close() layers of the grid must be outer.
/// Cost: O(N radius) for N voxels.
void close_gaps(VoxelGrid& grid, double radius);

} // namespace cagewright
