/// \file
/// Grids that are their own mirror images in the plane x = 0.
#pragma once

#include "obb/oriented_box.h"
#include "voxel/voxel_grid.h"
#include "voxel/voxelize.h"

namespace cagewright {

/// Makes voxelize() lay so many voxels and a half on either side that the plane lies between two
/// layers, and that the layers reach as far on one side as on the other.
///
/// \param frame  its first axis is the x axis; as wide on one side of the plane as on the other
void center_on_mirror_plane(OrientedBox& frame, VoxelizeOptions& options);

/// Occupies the mirror images of all occupied voxels of such a grid. \returns how many were added
std::size_t mirror_occupied(VoxelGrid& grid);

} // namespace cagewright
