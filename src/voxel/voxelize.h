/// \file
/// A mesh as a grid of voxels.
#pragma once

#include "obb/oriented_box.h"
#include "voxel/surface_patches.h"
#include "voxel/voxel_grid.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

struct VoxelizeOptions {
  int resolution = 64; ///< voxels along the frame's longest edge, both ends counted; 2 to 4096
  double margin = 0;   ///< in voxels: one is feature if the surface meets it grown by this
  /// surface_patches() of the mesh, if they are at hand; must live as long as the call.
  const SurfacePatches* patches = nullptr;
};

/// The voxels of a mesh in a frame: feature where it touches the surface, inner or outer elsewhere
/// as classify() decides, which survives open, inverted and dirty meshes.
///
/// The grid is aligned with the frame and covers it, and the mesh should that reach further, with
/// at least one layer of outer voxels on every side. Its voxels have the size (longest edge) /
/// (resolution - 1), so that the two faces across the longest edge lie half-way in their voxels;
/// along the other axes a face is never nearer than 0.23 voxels to a layer's boundary. Thus no
/// rounding decides which layers are occupied, and moved or scaled copies of a mesh give the same
/// kinds. A flat frame gives few layers.
///
/// The test for feature voxels is exact up to a millionth of a voxel, by which it errs towards
/// feature: every point of every triangle lies in feature voxels only. Vertices without a triangle
/// count as triangles without extent. There may be no inner voxel at all.
///
/// Errors: unfit_model (no points, no extent, a coordinate not finite), invalid_option, too_large
/// (more than 2^28 voxels, or than memory_allowed()), cancelled.
/// Cost: O(T + F + N) for T triangles, F feature and N all voxels; parallel over triangles. The
/// same on any number of threads.
Result<VoxelGrid> voxelize(TriangleView mesh, const OrientedBox& frame,
                           const VoxelizeOptions& options = {}, const Progress& progress = {});

} // namespace cagewright
