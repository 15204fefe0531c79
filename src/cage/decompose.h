/// \file
/// The first half of the pipeline: from a model to a tree of oriented boxes.
#pragma once

#include "cage/stage_time.h"
#include "cage/unit_frame.h"
#include "core/progress.h"
#include "core/result.h"
#include "mesh/triangle_mesh.h"
#include "obb/oriented_box.h"
#include "slicing/box_tree.h"
#include "voxel/voxel_grid.h"

#include <vector>

namespace cagewright {

/// What becomes of a model in several pieces.
enum class Pieces {
  together, ///< one cage: thin bridges of voxels join the pieces
  apart,    ///< a closed component of the cage for each piece, or group of pieces that touch
};

struct DecomposeOptions {
  int resolution = 64; ///< voxels along the longest axis of the model's box; 8 to 512
  Pieces pieces = Pieces::together;
  SlicingOptions slicing = {};
};

/// All that was made on the way to the boxes. Boxes and voxels are in the unit coordinates of
/// `frame`.
struct BoxDecomposition {
  UnitFrame frame;
  OrientedBox vertex_box; ///< PCA box of the model's vertices
  OrientedBox point_box;  ///< PCA box of the vertices and the voxel centers
  VoxelGrid grid;         ///< in the frame of point_box
  int bridges = 0;        ///< bridges of voxels that join the pieces
  BoxTree tree;
  std::vector<StageTime> times;
};

/// PCA box of the vertices, voxels in its frame, PCA box of vertices and voxel centers together,
/// voxels again, slicing.
///
/// \param model  any triangles: open, inverted, self-intersecting, in several pieces
/// Errors: unfit_model, invalid_option, cancelled.
/// Cost: a third of a second for 100,000 triangles at the default resolution, on two cores.
Result<BoxDecomposition> decompose(TriangleView model, const DecomposeOptions& options = {},
                                   const Progress& progress = {});

/// A box of a decomposition, in the coordinates of the model.
OrientedBox in_model_units(const UnitFrame& frame, const OrientedBox& box);

} // namespace cagewright
