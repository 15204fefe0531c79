/// \file
/// What cages with a budget have in common, whole or made by halves. Internal to this module.
#pragma once

#include "cage/budget_cage.h"

namespace cagewright {

/// How many vertices the budget allows: a closed surface has half as many as triangles, and two
/// more. 0: any number.
int vertices_of(const ImproveOptions& budget);

/// The envelope that a cage with these options starts from; `made` gets what is known about it.
///
/// \param extent    with half: that of the model and its mirror image in the plane x = 0
/// \param diagonal  what lengths are fractions of
/// Errors: those of envelope().
Result<TriangleMesh> start_from_envelope(TriangleView model, const BudgetCageOptions& options,
                                         CageExtent extent, double diagonal, BudgetCage& made,
                                         const Progress& progress = {});

} // namespace cagewright
