/// \file
/// Points that fill a model evenly.
#pragma once

#include "voxel/voxel_grid.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// The mesh's vertices followed by the centers of the inner and of the feature voxels, both in the
/// order of the grid. The centers outweigh uneven sampling of the surface by vertices.
std::vector<Vec3> point_set(TriangleView mesh, const VoxelGrid& grid);

} // namespace cagewright
