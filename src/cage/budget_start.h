/// \file
/// What cages with a budget have in common, whole or made by halves. Internal to this module.
#pragma once

#include "cage/budget_cage.h"

namespace cagewright {

/// How many vertices the budget allows: a closed surface has half as many as triangles, and two
/// more. 0: any number.
int vertices_of(const ImproveOptions& budget);

/// What decides between two cages within the budget: less is better. The objective, and what webs
/// between limbs and handles that are not the model's own add to it.
double cost_of(const BudgetCage& made, TriangleView model);

/// A half of something symmetric and its mirror image in x = 0, side by side: not joined.
TriangleMesh whole_of(TriangleMesh half);

/// The envelope that a cage with these options starts from; `made` gets what is known about it.
/// Unless the options say how it is to be made it is the best of several: of each a cage is made in
/// haste, and the one that comes out best by volume, gaps, webbing and handles is taken.
///
/// \param extent    with half: that of the model and its mirror image in the plane x = 0
/// \param diagonal  what lengths are fractions of
/// Errors: those of envelope().
Result<TriangleMesh> start_from_envelope(TriangleView model, const BudgetCageOptions& options,
                                         CageExtent extent, double diagonal, BudgetCage& made,
                                         const Progress& progress = {});

} // namespace cagewright
