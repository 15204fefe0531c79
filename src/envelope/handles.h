/// \file
/// Handles of a grid's surface, and how they are filled.
#pragma once

#include "voxel/voxel_grid.h"

namespace cagewright {

/// The handles of the surface of the occupied voxels, which has to be one manifold surface without
/// cavities: see make_manifold(). Nothing occupied may be on the grid's boundary.
int genus_of(const VoxelGrid& grid);

/// Fills the narrowest handles with skins of one voxel, until no more than `most` are left; leaves
/// the grid as it is if that takes gaps to be filled wider than twice `widest`, in voxels.
///
/// The surface is closed by balls that get larger until it has few enough handles; then what was
/// filled is carved away again as long as the topology stays: a voxel may go if the others hang
/// together round it as before (simple points; Bertrand and Malandain, "A new characterization of
/// three-dimensional simple points", 1994), the farthest from what was occupied first. So skins are
/// left where two fronts meet, in the middle of the hole.
///
/// \param grid      see make_manifold(); it grows by empty layers
/// \param mirrored  the grid is its own mirror image, and is to stay so
/// \returns the handles that are left
/// Cost: O(N) for N voxels, times the radii that are tried.
int fill_handles(VoxelGrid& grid, int most, double widest, bool mirrored);

} // namespace cagewright
