/// \file
/// The coarsest cage that stays near its model.
#pragma once

#include "improve/improve.h"
#include "validate/greatest_gap.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <functional>

namespace cagewright {

struct ImprovedToGap {
  Improved improved; ///< its report says whether the gap was kept, and why not
  double gap = 0;    ///< no point of the cage is farther from the model, in diagonals: proved
};

/// Bounds the distance from a cage, of which half may be given, to the model, to a tolerance: both
/// in the model's units.
using MeasureGap = std::function<GreatestGap(const TriangleMesh& cage, double tolerance)>;

/// Whether a gap is above the clearance, so that a cage may keep both. Errors: invalid_option.
Status can_keep_gap(double max_gap, double clearance);

/// Looks for the coarsest cage all of whose points are within `max_gap` of the model.
///
/// The distance is from every point of the cage's surface to the nearest point of the model: its
/// greatest value is bounded by greatest_gap(), not sampled. First improve() is asked for such a
/// cage directly: ImproveOptions::max_gap. Where that does not do, numbers of vertices are guessed
/// from the gaps of the cages made so far; a cage that is fine enough is the start of the coarser
/// ones. Eight runs more at most; fewer when the next coarser cage that was tried and failed has
/// nearly as many vertices (a sixteenth fewer).
///
/// \param options  its vertices and faces are limits; 0: none. If they do not allow the gap, the
///                 nearest cage within them is returned, and the report says so.
/// \param max_gap  in diagonals of the model's box
/// \param measure  what decides how far a cage is from the model
/// Errors: those of improve() and can_keep_gap().
Result<ImprovedToGap> improve_to_gap(TriangleView start, TriangleView model,
                                     const ImproveOptions& options, double max_gap,
                                     const MeasureGap& measure, const Progress& progress = {});

/// The same for a whole cage, by greatest_gap().
Result<ImprovedToGap> improve_to_gap(TriangleView start, TriangleView model,
                                     const ImproveOptions& options, double max_gap,
                                     const Progress& progress = {});

} // namespace cagewright
