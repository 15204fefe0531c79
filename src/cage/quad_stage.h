/// \file
/// Cages of quads within a budget. Internal to this module.
#pragma once

#include "cage/budget_cage.h"
#include "cage/limb_rings.h"
#include "spatial/bvh.h"

#include <functional>
#include <optional>

namespace cagewright {

/// Makes a cage of at most so many triangles (0: as the options say) no point of which is farther
/// from the model than max_gap, in diagonals (0: anywhere), and keeps the rings.
using MakeTriangles = std::function<Result<Improved>(
    int faces, double max_gap, const LimbRings& rings, const Progress& progress)>;

/// How far the whole cage of which this is all, or half, is from the model at most, along any
/// diagonals: in the model's units, to within `tolerance`.
using MeasureQuadGap = std::function<double(const PolygonMesh& cage, double tolerance)>;

/// That of a whole cage.
double greatest_gap_of_quads(const PolygonMesh& cage, const TriangleBvh& model, double tolerance);

/// What quads are made for, and with.
struct QuadTask {
  MakeTriangles make_triangles;
  MeasureQuadGap gap_of;  ///< asked only if a greatest gap is
  const LimbRings& rings; ///< on the start: edges of the quads, unless the budget does not allow it
  TriangleView model;     ///< what the cage, or its half, must enclose
  const BudgetCageOptions& options;
  const ImproveOptions& budget; ///< of the whole cage, with the density for the vertices of `model`
  double diagonal = 0;          ///< what lengths are fractions of
};

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
/// Errors: those of make_triangles() and make_quads().
Result<QuadStage> make_quads_in_budget(const QuadTask& task, const Progress& progress = {});

} // namespace cagewright
