/// \file
/// The objective of cages of quads. Internal to this module.
#pragma once

#include "improve/objective.h"
#include "quads/quads.h"

namespace cagewright {

/// \param face_area  of a typical triangle of the cage
inline ObjectiveWeights weights_for(TriangleView model, const QuadOptions& options,
                                    double face_area) {
  ObjectiveWeights weights;
  weights.square = options.square;
  weights.shape = options.shape;
  weights.typical_area = face_area;
  set_emphasis(weights, model, options.density);
  return weights;
}

} // namespace cagewright
