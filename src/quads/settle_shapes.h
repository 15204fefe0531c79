/// \file
/// Thin faces of a cage of quads made rounder in the end.
#pragma once

#include "quads/relax_quads.h"

namespace cagewright {

/// Of the triangles that the cage is cut into, quads along their shorter diagonals, the share that
/// is long and thin: 2 r / R below 0.152, a little more than shape_limits::thin.
double thin_share(const QuadCage& cage);

/// Relaxes the cage again while more than one triangle in twenty is thin, seven times at most,
/// weighing thin triangles and flat corners three times as much each time. Then it is tightened
/// once more as before, so that no face becomes thin. The cage stays as it was if all that makes it
/// dearer, by the objective times dearer_by_thin(): the faces of long thin limbs are long and thin.
///
/// \param options  how it was relaxed before: its weights are where this begins
void settle_shapes(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress = {});

} // namespace cagewright
