/// \file
/// Cages that are their own mirror images.
#pragma once

#include "cage/budget_cage.h"
#include "symmetry/half.h"

#include <optional>
#include <string>

namespace cagewright {

/// The plane that a cage is to be mirrored in, as the options say; none if the cage is not to be
/// mirrored, and then the reason, unless that is what was asked for.
struct ChosenPlane {
  std::optional<MirrorPlane> plane;
  std::string why_not;
};

ChosenPlane choose_mirror_plane(TriangleView model, const BudgetCageOptions& options,
                                const Progress& progress = {});

/// make_budget_cage() for a cage that is its own mirror image in the plane: it encloses the model
/// and the model's mirror image. Half of it is made and improved, in coordinates where the plane is
/// x = 0; then the halves are joined and the whole is checked against the model.
///
/// A union of boxes does not heed the plane: what it has on one side is cut off there, and takes
/// the place of the other side. If that gives no valid surface to start from, the envelope is
/// taken, and `why_not_boxes` says so.
///
/// Errors: those of make_budget_cage().
Result<BudgetCage> make_symmetric_cage(TriangleView model, const MirrorPlane& plane,
                                       const BudgetCageOptions& options,
                                       const Progress& progress = {});

} // namespace cagewright
