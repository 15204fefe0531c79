/// \file
/// The whole pipeline: from a model to a cage that is proved valid.
#pragma once

#include "cage/hexahedron.h"
#include "cage/register_boxes.h"
#include "cage/unit_frame.h"
#include "core/progress.h"
#include "core/result.h"
#include "mesh/triangle_mesh.h"
#include "obb/oriented_box.h"
#include "slicing/box_tree.h"
#include "voxel/voxel_grid.h"

#include <string>
#include <vector>

namespace cagewright {

/// What becomes of a model in several pieces.
enum class Pieces {
  together, ///< one cage: thin bridges of voxels join the pieces
  apart,    ///< a closed component of the cage for each piece, or group of pieces that touch
};

struct GenerateOptions {
  int resolution = 64; ///< voxels along the longest axis of the model's box; 8 to 512
  SlicingOptions slicing = {};
  bool registration = true; ///< join the faces of neighbouring boxes where they fit
  Pieces pieces = Pieces::together;
};

struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// All that the pipeline made on its way. Boxes, voxels and solids are in the unit coordinates of
/// `frame`; the cage is in the model's own.
struct BoxDecomposition {
  UnitFrame frame;
  OrientedBox vertex_box; ///< PCA box of the model's vertices
  OrientedBox point_box;  ///< PCA box of the vertices and the voxel centers
  VoxelGrid grid;         ///< in the frame of point_box
  int bridges = 0;        ///< bridges of voxels that join the pieces
  BoxTree tree;
  std::vector<StageTime> times;
};

struct GeneratedCage {
  TriangleMesh cage; ///< valid in the sense of validate_cage(), on exactly these coordinates
  BoxDecomposition boxes;
  std::vector<int> leaves; ///< nodes of the tree whose boxes the cage was made of
  Registration registration;
  std::vector<StageTime> times; ///< of all stages, those of `boxes` included
};

/// The pipeline up to the tree of boxes (design stages: PCA box, voxels, second PCA box and voxels,
/// slicing).
///
/// \param model  any triangles: open, inverted, self-intersecting, in several pieces
/// Errors: unfit_model, invalid_option, cancelled.
Result<BoxDecomposition> decompose(TriangleView model, const GenerateOptions& options = {},
                                   const Progress& progress = {});

/// A cage of the model: the union of the boxes of a decomposition, checked exactly against the
/// model on the coordinates that are returned.
///
/// Errors: those of decompose(), and no_valid_cage when the result did not pass the check.
/// Cost: below a second before the union for 100,000 triangles; the union takes about 30 ms a box.
Result<GeneratedCage> generate_cage(TriangleView model, const GenerateOptions& options = {},
                                    const Progress& progress = {});

/// A box of a decomposition, in the coordinates of the model.
OrientedBox in_model_units(const UnitFrame& frame, const OrientedBox& box);

} // namespace cagewright
