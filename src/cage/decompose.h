/// \file
/// The first half of the pipeline: from a model to a tree of oriented boxes.
#pragma once

#include "cage/stage_time.h"
#include "cage/unit_frame.h"
#include "obb/oriented_box.h"
#include "slicing/box_tree.h"
#include "voxel/voxel_grid.h"
#include <cagewright/cage/generate_options.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

struct DecomposeOptions {
  int resolution = 64; ///< voxels along the longest axis of the model's box; 8 to 512
  Pieces pieces = Pieces::together;
  SlicingOptions slicing = {};
  /// In diagonals of the model's box: the boxes enclose every voxel that comes so near to the
  /// model, so that their surface keeps this distance. 0: those that touch it.
  double clearance = 0;
};

/// What these options say of the boxes. Their clearance is not heeded: Method::boxes has none.
DecomposeOptions decompose_options(const GenerateOptions& options);

/// All that was made on the way to the boxes.
struct BoxDecomposition {
  UnitFrame frame;        ///< between the model's coordinates and unit coordinates
  OrientedBox vertex_box; ///< PCA box of the model's vertices, in unit coordinates
  OrientedBox point_box;  ///< PCA box of vertices and voxel centers, in unit coordinates
  VoxelGrid grid;         ///< in the frame of point_box, in unit coordinates
  int bridges = 0;        ///< bridges of voxels that join the pieces
  /// Boxes and cuts in the coordinates of the grid, in which voxel (i, j, k) is the cube from
  /// (i, j, k) to (i+1, j+1, k+1). There all input is whole numbers: moved and scaled copies of a
  /// model, which give the same voxels, give the very same tree.
  BoxTree tree;
  std::vector<StageTime> times;

  /// The edge of a voxel in the model's units.
  [[nodiscard]] double voxel_size() const { return grid.size * frame.diagonal; }
  /// From grid coordinates to the model's.
  [[nodiscard]] Vec3 to_model(const Vec3& p) const { return frame.from_unit(grid.to_world(p)); }
  [[nodiscard]] OrientedBox to_model(const OrientedBox& box) const {
    return {to_model(box.center), grid.axes * box.axes, box.half * voxel_size()};
  }
};

/// The same voxels in the grid's own coordinates: unit cubes along the axes, from the origin.
VoxelGrid in_grid_coordinates(const VoxelGrid& grid);

/// PCA box of the vertices, voxels in its frame, PCA box of vertices and voxel centers together,
/// voxels again, slicing.
///
/// \param model  any triangles: open, inverted, self-intersecting, in several pieces
/// Errors: unfit_model, invalid_option, cancelled.
/// Cost: a third of a second for 100,000 triangles at the default resolution, on two cores.
Result<BoxDecomposition> decompose(TriangleView model, const DecomposeOptions& options = {},
                                   const Progress& progress = {});

} // namespace cagewright
