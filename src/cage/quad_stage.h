/// \file
/// Cages of quads within a budget. Internal to this module.
#pragma once

#include "cage/budget_cage.h"
#include "cage/limb_rings.h"

#include <functional>
#include <optional>
#include <span>

namespace cagewright {

/// Makes a cage of at most so many triangles (0: as the options say) no point of which is farther
/// from the model than max_gap, in diagonals (0: anywhere), and keeps the rings.
using MakeTriangles = std::function<Result<Improved>(
    int faces, double max_gap, const LimbRings& rings, const Progress& progress)>;

struct QuadStage {
  ImproveReport report; ///< of the triangles that the quads were made of
  Quadrangulated made;
  std::optional<double>
      gap; ///< with max_gap: no point is farther, along any diagonals; in diagonals
};

/// Triangles, and quads made of them. The faces that are counted are those of the result, so that
/// more triangles are made to begin with, and fewer if they were too many; the gap, which quads
/// widen, is asked to be less of the triangles until that of the quads is what was asked for.
///
/// \param rings     on the start: they become edges of the quads, unless the budget does not allow
///                  it
/// \param model     what the cage, or its half, must enclose
/// \param budget    of the whole cage, with the density for the vertices of `model`
/// \param diagonal  what lengths are fractions of
/// Errors: those of make_triangles() and make_quads().
Result<QuadStage> make_quads_in_budget(const MakeTriangles& make_triangles, const LimbRings& rings,
                                       TriangleView model, const BudgetCageOptions& options,
                                       const ImproveOptions& budget, double diagonal,
                                       const Progress& progress = {});

} // namespace cagewright
