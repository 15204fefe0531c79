/// \file
/// Voxels whose surface is manifold.
#pragma once

#include "voxel/voxel_grid.h"

namespace cagewright {

/// Fills cavities: outer voxels that no way through faces leads to from the grid's boundary become
/// inner. \returns how many
std::size_t fill_cavities(VoxelGrid& grid);

/// Whether in the block of 2 x 2 x 2 voxels from (i, j, k) on the occupied ones hang together by
/// faces, and so do the others.
bool is_well_composed(const VoxelGrid& grid, int i, int j, int k);

/// Marks further voxels as inner until the surface of the occupied ones is manifold: every
/// block of 2 x 2 x 2 voxels is well-composed (Latecki, "3D Well-Composed Pictures", 1997).
/// \returns how many
std::size_t make_well_composed(VoxelGrid& grid);

/// Both, until the surface is manifold and without cavities.
///
/// \param mirrored  the grid is to be its own mirror image: see mirror_occupied()
void make_manifold(VoxelGrid& grid, bool mirrored);

} // namespace cagewright
