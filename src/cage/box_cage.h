/// \file
/// A cage that is the union of oriented boxes.
#pragma once

#include "cage/decompose.h"
#include "cage/register_boxes.h"
#include "cage/stage_time.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <memory>
#include <vector>

namespace cagewright {

/// How the boxes of a cage were found.
struct BoxesMade {
  BoxDecomposition boxes;
  std::vector<int> leaves;   ///< nodes of the tree whose boxes the cage was made of
  Registration registration; ///< the solids that were united, in grid coordinates
};

struct BoxCage {
  TriangleMesh cage; ///< valid in the sense of validate_cage(), on exactly these coordinates
  PolygonMesh faces; ///< what is written: `cage`, or with quads; valid along either diagonal
  std::shared_ptr<const BoxesMade> made;
  std::vector<StageTime> times; ///< of all stages, those of the decomposition included
};

/// A cage of the model: the union of the boxes of a decomposition, checked exactly against the
/// model on the coordinates that are returned.
///
/// Errors: those of decompose(), and no_valid_cage when the result did not pass the check.
/// Cost: below a second before the union for 100,000 triangles; the union takes 2 to 20 ms a box.
///
/// \param clearance  in diagonals, that the boxes keep; 0: they enclose the voxels that touch the
///                   model
Result<BoxCage> make_box_cage(TriangleView model, const GenerateOptions& options = {},
                              double clearance = 0, const Progress& progress = {});

} // namespace cagewright
