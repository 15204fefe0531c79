/// \file
/// Triangles within a budget, or within a gap. Internal to this module.
#pragma once

#include "cage/ground.h"
#include "improve/improve.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <functional>
#include <optional>

namespace cagewright {

struct Triangles {
  Improved improved;         ///< its report says whether what was asked for was kept, and why not
  std::optional<double> gap; ///< if one was asked for: no point of the whole cage is farther from
                             ///< the model, in diagonals: proved
  std::optional<Vec3> farthest; ///< of the whole cage, in the model's coordinates, if that is more
                                ///< than was asked for
};

/// As improve(), on the ground. If a triangle of the cage is a needle then, or too many are thin,
/// it is tried again with more weight on shape, twice at most: see Merit. A cage that cannot be
/// brought down to the budget stays as it is: that takes long enough once.
///
/// Errors: those of improve(). Cost: at most three runs of improve().
Result<Triangles> improve_well_shaped(const Ground& ground, TriangleView start,
                                      const ImproveOptions& budget, const Progress& progress = {});

/// What makes triangles within a budget.
using Improver = std::function<Result<Triangles>(const ImproveOptions& budget, const Progress&)>;

/// Triangles within a budget. Where webs are left it is tried again with webs dearer than other
/// volume, and the better cage is taken: few vertices may be better spent elsewhere.
///
/// Errors: those of the improver, which is run twice at most.
Result<Triangles> improve_without_webs(const Ground& ground, ImproveOptions budget,
                                       const Improver& improver, const Progress& progress = {});

/// Whether a gap is above the clearance, so that a cage may keep both. Errors: invalid_option.
Status can_keep_gap(double max_gap, double clearance);

/// Looks for the coarsest cage all of whose points are within `max_gap` of the model.
///
/// The distance is from every point of the cage's surface to the nearest point of the model: its
/// greatest value is bounded by greatest_gap(), not sampled. First improve() is asked for such a
/// cage directly: ImproveOptions::max_gap. Where that does not do, numbers of vertices are guessed
/// from the gaps of the cages made so far; a cage that is fine enough is the start of the coarser
/// ones; fewer runs when the next coarser cage that was tried and failed has nearly as many
/// vertices (a sixteenth fewer).
///
/// \param budget   its vertices and faces are limits; 0: none. If they do not allow the gap, the
///                 nearest cage within them is returned, and the report says so.
/// \param max_gap  in diagonals
/// Errors: those of improve(). Cost: at most eleven runs of improve().
Result<Triangles> improve_to_gap(const Ground& ground, TriangleView start,
                                 const ImproveOptions& budget, double max_gap,
                                 const Progress& progress = {});

} // namespace cagewright
