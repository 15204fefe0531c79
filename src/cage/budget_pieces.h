/// \file
/// A cage of several closed pieces within one budget. Internal to this module.
#pragma once

#include "cage/budget_cage.h"
#include "cage/pieces.h"

#include <functional>

namespace cagewright {

/// Makes a cage of one piece.
using MakeCage =
    std::function<Result<BudgetCage>(TriangleView, const BudgetCageOptions&, const Progress&)>;

/// A closed cage for each group, all within the budget of the options; groups whose cages meet or
/// lie one within another (by exact predicates) are joined, and a cage is made for them together.
/// So are groups that are no surface, not five times as large as the clearance, or too many for the
/// budget: with the group whose box is nearest.
///
/// The result is closed and free of crossings, but not judged against the model.
/// Errors: those of `make_one`.
Result<BudgetCage> make_pieces(TriangleView model, PieceGroups groups,
                               const BudgetCageOptions& options, const MakeCage& make_one,
                               const Progress& progress = {});

} // namespace cagewright
