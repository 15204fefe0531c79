/// \file
/// From any valid cage to a good one with few vertices.
#pragma once

#include "improve/cage_extent.h"
#include "improve/seam_band.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <span>
#include <string>
#include <vector>

namespace cagewright {

class SpaceBetween;
struct ModelSurface;

struct ImproveOptions {
  /// At most so many; 0: no limit, but no more than the start has.
  int vertices = 100;
  int faces = 0; ///< at most so many triangles; 0: no limit
  /// Least distance from every face of the cage to the model, in diagonals of the model's box. The
  /// start must keep it.
  double clearance = 0.002;
  int most_valence = 10; ///< faces at a vertex, unless the start has more or the budget needs more
  /// How often, at most, the cage is refined and simplified again, to move vertices to where they
  /// pay.
  int rounds = 6;
  /// Only a quick way to the budget, to see what a start is worth.
  bool draft = false;
  double square = 40;  ///< weight of large gaps: see ObjectiveWeights
  double shape = 7e-4; ///< weight of well shaped faces: see ObjectiveWeights
  /// How many times its final number of vertices, and 300 more, the cage has when the quick way of
  /// simplifying it, which lets it grow, gives way to the careful one.
  double careful_from = 5;
  /// Where the cage is to be finer: one weight above 0 for each vertex of the model, or empty:
  /// even. Only ratios matter. Where the weight is four times as large the edges of the cage come
  /// out about half as long (edge length ~ 1 / sqrt(density)); ratios beyond 100 count as 100. The
  /// view must live as long as the call.
  std::span<const double> density = {};
  /// Whether the start is a whole cage or half of one. If so the result is half of one too; the
  /// budget and the report are those of the whole.
  CageExtent extent = CageExtent::whole;
  /// Make the coarsest cage no face of which is farther from the model than this, in diagonals, at
  /// any of fifteen points of it; the budget is then a limit, which goes before. Where no split
  /// brings the cage nearer, over a hollow, it may stay farther away. 0: as fine as the budget
  /// allows.
  double max_gap = 0;
  /// What lengths are fractions of. 0: the diagonal of the model's box.
  double diagonal = 0;
  /// The space between the model's limbs, that the cage is to keep out of even where that costs
  /// tightness elsewhere; of half a cage that at x > 0. Null: webs count as other volume does. Must
  /// live as long as the call.
  const SpaceBetween* between = nullptr;
  /// The part that each face of the start belongs to, or empty. The edges between two parts, which
  /// have to be loops without common vertices, stay loops of edges of the cage, with four of them
  /// at least: rings round limbs. The view must live as long as the call.
  std::span<const Index> parts = {};
  /// By part: where the loop stays that separates it from parts of smaller numbers. Or empty.
  std::span<const SeamBand> bands = {};
};

struct ImproveReport {
  bool reached = false; ///< the budget was met
  std::string why_not;  ///< a sentence, if it was not
  double objective = 0; ///< of the result, as in objective.h, without webbing, in diagonals cubed
  double simplify_seconds = 0;
  double refine_seconds = 0;
};

struct Improved {
  TriangleMesh cage;
  std::vector<Index> parts; ///< of its faces, if those of the start have some
  ImproveReport report;
};

/// Simplifies and tightens a cage round a model.
///
/// The start is closed, manifold, oriented outward, free of self-intersections, encloses the model
/// and keeps the clearance: so does the result, because no change is made that was not checked. If
/// the budget cannot be met the smallest cage found is returned, and the report says why.
///
/// Of the model for half a cage, what lies at x < 0 should be the mirror image of what lies at
/// x > 0; it may be left out, apart from triangles that the plane cuts.
///
/// Errors: invalid_option, invalid_cage (the start has no faces), unfit_model (the model has no
/// vertices), cancelled. The same result on any number of threads.
Result<Improved> improve(TriangleView start, TriangleView model, const ImproveOptions& options = {},
                         const Progress& progress = {});

/// The same for a model that has been looked at already: lengths are fractions of its `diagonal`,
/// whatever the options say.
Result<Improved> improve(TriangleView start, const ModelSurface& model,
                         const ImproveOptions& options = {}, const Progress& progress = {});

} // namespace cagewright
