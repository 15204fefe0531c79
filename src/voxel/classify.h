/// \file
/// Which voxels are inside.
#pragma once

#include "voxel/surface_patches.h"
#include "voxel/voxel_grid.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

/// Decides for every voxel that is not feature whether it is inner or outer. The feature voxels of
/// the mesh are marked already.
///
/// 1. Orientation. Faces that occur twice are counted once. Faces are turned to agree across the
///    edges that two of them share; each patch so connected is turned outward: a closed one by its
///    volume, an open one so that rays from outside meet its front first.
/// 2. Votes. From every voxel six rays go out along the grid's axes; a ray says inside if it leaves
///    the surface more often than it enters. That is right in every direction for closed patches,
///    nested and intersecting ones included, and in all directions but those of the holes for
///    open ones.
/// 3. Regions. The voxels between the feature voxels fall into regions connected by faces. One that
///    does not reach the grid's boundary is decided as a whole by its mean vote, so that no single
///    ray makes a speckle. The one that does is outer throughout if all patches are closed; else
///    the inside may have leaked out through a hole wider than a voxel, and each voxel is decided
///    by the votes of its neighbourhood.
///
/// Flooding from outside, the usual method, fails at the leak; parity along one axis, the other,
/// fails behind every hole, doubled face and stray sheet. A cavity (a closed shell inside another)
/// counts as inner, since a cage goes round it.
///
/// Errors: cancelled. Cost: O(T + N) for T triangles and N voxels, save that crossings are sorted
/// along each ray. The same on any number of threads.
Status classify(TriangleView mesh, VoxelGrid& grid, const Progress& progress = {});

/// The same with the mesh's patches, if they are at hand.
Status classify(TriangleView mesh, const SurfacePatches& patches, VoxelGrid& grid,
                const Progress& progress = {});

} // namespace cagewright
