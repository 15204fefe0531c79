/// \file
/// Neighbouring faces exchanged for others with the same border.
#pragma once

#include "quads/pairing.h"
#include <cagewright/core/progress.h>

namespace cagewright {

/// Takes two or three neighbouring faces at a time, tries all ways to tile what they cover by
/// triangles and quads with no more triangles than before, and exchanges them where that lowers the
/// cost, the best first, until nothing does. That moves lone triangles together, turns edges
/// along the field, and evens out how many faces meet at a vertex. The cage stays valid, under
/// every choice of diagonals, and its parts keep their borders. \returns how many were exchanged
std::size_t retile(QuadCage& cage, const QuadGuard& guard, const DirectionField& field,
                   const Taste& taste, const Progress& progress = {});

} // namespace cagewright
