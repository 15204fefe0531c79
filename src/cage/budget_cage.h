/// \file
/// A cage of at most so many vertices.
#pragma once

#include "cage/box_cage.h"
#include "improve/improve.h"
#include "quads/quads.h"
#include "symmetry/half.h"
#include <cagewright/cage/generate_options.h>

#include <optional>
#include <string>
#include <vector>

namespace cagewright {

/// What a cage is made from before it is improved.
enum class CageStart {
  envelope, ///< a surface of voxels: any topology, tight everywhere
  obb,      ///< the union of oriented boxes
};

/// How an envelope is made.
struct EnvelopeSetting {
  int resolution = 0; ///< voxels along the model's diagonal
  double closing = 0; ///< gaps narrower than twice this, in diagonals, are filled
};

struct BudgetCageOptions {
  CageStart start = CageStart::envelope;
  ImproveOptions improve = {}; ///< the budget and the clearance among them
  /// Make the coarsest cage no point of which is farther from the model than this, in diagonals of
  /// its box; the budget is then a limit. 0: as fine as the budget allows. See improve_to_gap().
  double max_gap = 0;
  int resolution = 0; ///< of the envelope: voxels along the model's diagonal; 0: chosen
  double closing = 0; ///< of the envelope: gaps narrower than twice this are filled
  /// How many vertices the envelope is made for: the fewer, the more of the model's handles are
  /// filled. 0: those of the budget; and if that cannot be met, half as many.
  int envelope_vertices = 0;
  /// Of the boxes. Their Pieces hold for both starts: with Pieces::apart each group of pieces gets
  /// a closed cage of its own, and a share of the budget by its surface area; groups whose cages
  /// would meet or lie one within another, or that are too small for the budget, are joined.
  BoxCageOptions boxes = {};
  Symmetry symmetry = Symmetry::off;
  Vec3 origin = Vec3::Zero(); ///< of the user's coordinates: mirror planes through it are preferred
  /// Quads where they can be. A quad counts as one face. The clearance, the density and the
  /// objective are those of `improve`.
  bool quads = false;
  QuadOptions quad_options = {};
};

struct BudgetCage {
  TriangleMesh cage; ///< valid in the sense of validate_cage(), on exactly these coordinates
  /// With quads: what is written. `cage` is triangulate() of it, but it is valid, and keeps the
  /// clearance, along any choice of diagonals.
  std::optional<PolygonMesh> polygons;
  std::optional<QuadReport> quads;
  /// With quads: closed loops of edges round limbs, where they begin or bend, as vertices in order.
  std::vector<std::vector<Index>> limb_rings;
  ImproveReport report;
  double clearance = 0; ///< that the improvement kept: less than asked for if the boxes came nearer
  double clearance_asked = 0;
  std::size_t start_vertices = 0;
  int resolution = 0; ///< of the envelope
  int genus = 0;      ///< of the envelope: its handles
  int known = 0;      ///< handles that the model itself has, as far as is known
  /// An envelope that promised about as much as the one taken, if there was one.
  std::optional<EnvelopeSetting> rival;
  int bridges = 0; ///< of the envelope: rods that join pieces of the model
  int pieces = 1;  ///< closed surfaces of the cage
  int joined = 0;  ///< groups of pieces that are apart, yet had to share a cage with others
  /// With max_gap: no point of the cage is farther from the model, in diagonals: proved.
  std::optional<double> gap;
  std::optional<BoxCage> boxes;        ///< what the boxes gave, if they were the start
  std::string why_not_boxes;           ///< if they were to be the start, and were not
  std::optional<MirrorPairing> mirror; ///< of a cage that is its own mirror image
  std::string why_not_mirrored;        ///< if it was to be, and is not
  std::vector<StageTime> times;
};

/// A cage of the model with at most so many vertices or faces: the start, improved, and checked
/// exactly against the model. If the budget cannot be met it is the smallest cage that was found,
/// and the report says why.
///
/// Errors: those of make_box_cage(), envelope() and improve(); no_valid_cage when the result did
/// not pass the check.
Result<BudgetCage> make_budget_cage(TriangleView model, const BudgetCageOptions& options = {},
                                    const Progress& progress = {});

} // namespace cagewright
