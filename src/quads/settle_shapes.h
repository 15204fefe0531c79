/// \file
/// Thin faces of a cage of quads made rounder in the end.
#pragma once

#include "quads/relax_quads.h"

namespace cagewright {

/// Of the faces, those that have a long and thin triangle (2 r / R below 0.152) along either
/// diagonal; 0 to 1.
double thin_share(const QuadCage& cage);

/// Relaxes the cage again while more than one face in twenty is thin, seven times at most, weighing
/// thin triangles and flat corners three times as much each time. Then it is tightened once more as
/// before, so that no face becomes thin.
///
/// \param options  how it was relaxed before: its weights are where this begins
void settle_shapes(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress = {});

} // namespace cagewright
