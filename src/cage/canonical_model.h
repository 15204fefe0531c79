/// \file
/// A model told apart from its unit, its place and the order it is listed in. Internal to this
/// module.
#pragma once

#include "cage/unit_frame.h"
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// A model in its unit frame, its coordinates rounded to a grid, vertices and triangles in an order
/// that follows from their places alone. Shifted, scaled and shuffled copies of a model have the
/// same: their coordinates differ by rounding only, and that hardly ever across half a cell of the
/// grid.
struct CanonicalModel {
  TriangleMesh mesh;
  std::vector<Index> vertices; ///< of each vertex the model's that it is
  UnitFrame frame;
};

/// How fine the grid is, in diagonals, that a model's coordinates may be rounded to if a clearance
/// is to be kept. No point of the surface moves by more than that.
double canonical_grid(double clearance);

/// \param frame  unit_frame() of the model
/// \returns something else if it is to stop
CanonicalModel canonical_model(TriangleView model, const UnitFrame& frame, double grid,
                               const Progress& progress = {});

/// A cage of the canonical model as one of the model that it was made from. Vertices that are each
/// other's mirror images are paired anew, exactly across one of the world's axes: see MirrorFrame.
void bring_back(GeneratedCage& made, TriangleView model, const UnitFrame& frame);

} // namespace cagewright
