/// \file
/// A cage of several closed pieces within one budget. Internal to this module.
#pragma once

#include "cage/budget_cage.h"
#include "cage/pieces.h"

#include <functional>

namespace cagewright {

/// What the least cage has: a box, of triangles.
inline constexpr int vertices_for_a_piece = 8;
inline constexpr int faces_for_a_piece = 2 * vertices_for_a_piece - 4;

/// Makes a cage round a model.
using MakeCage =
    std::function<Result<BudgetCage>(TriangleView, const BudgetCageOptions&, const Progress&)>;

/// One or several closed surfaces of the same shape.
struct AlikeSurfaces {
  TriangleMesh model; ///< what one of them is to enclose
  int count = 1;
};

/// How a part of the model gets its cage.
struct PieceMaker {
  MakeCage make;
  std::function<AlikeSurfaces(TriangleView)> surfaces; ///< of the cage that is made of a part
};

/// A cage for each group, all within the budget of the options; groups whose cages meet or lie one
/// within another (by exact predicates) are joined, and a cage is made for them together. So are
/// groups that are no surface, not five times as large as the clearance, or too many for the
/// budget: with the group whose box is nearest.
///
/// The result is closed and free of crossings, but not judged against the model. It is its own
/// mirror image if the cages of all groups are.
/// Errors: those of `maker`.
Result<BudgetCage> make_pieces(TriangleView model, PieceGroups groups,
                               const BudgetCageOptions& options, const PieceMaker& maker,
                               const Progress& progress = {});

} // namespace cagewright
