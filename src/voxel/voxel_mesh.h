/// \file
/// Voxels as a mesh, to look at.
#pragma once

#include "voxel/voxel_grid.h"
#include <cagewright/mesh/polygon_mesh.h>

#include <vector>

namespace cagewright {

/// The surfaces of the voxels of each of these kinds: a quad wherever a voxel of the kind borders
/// one of another kind, facing outward, in a group named "outer", "inner" or "feature". Groups
/// follow each other in the order given. Corners are shared within and among the groups.
PolygonMesh voxel_boxes(const VoxelGrid& grid, const std::vector<VoxelKind>& kinds = {
                                                   VoxelKind::feature, VoxelKind::inner});

} // namespace cagewright
