/// \file
/// A cage of quads that begins as one: blocks round a model, tightened.
#pragma once

#include "improve/guard.h"
#include "quads/quads.h"
#include <cagewright/core/progress.h>

namespace cagewright {

struct GridQuadOptions {
  QuadOptions quads = {};
  int vertices = 100; ///< at most so many, of the whole cage; 0: no limit
  int faces = 0;      ///< at most so many, of the whole cage; 0: no limit; not both
  bool half = false;  ///< the model is half of a symmetric one, and so is the cage
  /// Given up when the looseness() is above this before loops are exchanged. 0: never.
  double loosest = 0;
  /// Given up where the exchange of loops would have to lower the objective to less than this by
  /// more than it does. 0: never.
  double dearest = 0;
};

/// The surface of a grid_layout(), tightened, with edge loops put where they pay: all faces are
/// quads, four meet at a vertex but where limbs begin and end, and rings of edges run round limbs
/// and body. It is valid and keeps the clearance, along any choice of diagonals.
///
/// Errors: invalid_option, unfit_model, too_large, no_valid_cage (the blocks are none, or too
/// loose), cancelled. If there is no layout so small the result has more vertices than were asked
/// for. The same result on any number of threads.
Result<Quadrangulated> make_grid_quads(TriangleView model, const GridQuadOptions& options,
                                       const Progress& progress = {});

/// The same for a model that has been looked at already: lengths are fractions of its `diagonal`,
/// whatever the options say.
Result<Quadrangulated> make_grid_quads(const ModelSurface& model, const GridQuadOptions& options,
                                       const Progress& progress = {});

/// What there is between a cage and its model: the integral over the faces, cut as they are
/// written, of d + square d^2 / D, d the distance to the model and D its diagonal.
double looseness(const PolygonMesh& cage, const ModelSurface& model, const QuadOptions& options);

} // namespace cagewright
