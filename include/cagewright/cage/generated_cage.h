/// \file
/// A cage, and how it came about.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/quads/quad_report.h>
#include <cagewright/symmetry/mirror_pairing.h>
#include <cagewright/validate/cage_metrics.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

struct BoxesMade; // every box, cut and cross-section, for the programs of this repository

/// How long a stage took.
struct StageTime {
  std::string stage;
  double seconds = 0; ///< by the wall clock
};

/// Something that is not as it was asked for, or might be expected.
enum class Reason {
  budget_not_reached, ///< more vertices or faces than asked for: the smallest cage that was found
  gap_not_kept,       ///< some point of the cage is farther from the model than asked for
  clearance_not_kept, ///< the start came nearer to the model than asked for
  boxes_not_possible, ///< an envelope was taken where boxes were asked for
  not_mirrored,       ///< the cage is not its own mirror image
  pieces_joined,      ///< groups of pieces that are apart share a closed surface
  start_changed,      ///< of the cage that was given to start from more than places was changed
  specks_enclosed,    ///< tiny pieces far from the rest make the cage large: see find_specks()
  specks_ignored,     ///< such pieces are not enclosed, as was asked for
  openings_closed,    ///< of an open model, as was asked for: how many
};

/// As in JSON: "budget_not_reached".
std::string_view name_of(Reason reason);

struct Remark {
  Reason reason = Reason::budget_not_reached;
  std::string message;       ///< a sentence for a person, without a full stop
  bool is_shortfall = false; ///< the options asked for it: otherwise it is only told
  std::optional<Vec3> place; ///< where it is, if it is somewhere: in the model's coordinates
};

/// A box of the union, in the model's coordinates.
struct CageBox {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity(); ///< columns, of length one, right-handed
  Vec3 half = Vec3::Ones();     ///< half the edges along them
};

struct GeneratedCage {
  /// The cage as it is written. Valid in the sense of validate_cage(), on exactly these
  /// coordinates, along any choice of diagonals.
  PolygonMesh faces;
  TriangleMesh triangles; ///< triangulate() of it
  CageMetrics figures;

  // How it was made.

  Method method = Method::envelope; ///< what it was made from: see Reason::boxes_not_possible
  bool is_own = false;              ///< it has the faces of GenerateOptions::start
  std::size_t start_vertices = 0;   ///< of the surface that was improved
  int resolution = 0;               ///< of the envelope: voxels along the model's diagonal
  int genus = 0;                    ///< of the envelope: its handles
  int bridges = 0;                  ///< that join pieces of the model
  int pieces = 1;                   ///< closed surfaces of the cage
  int joined = 0;       ///< groups of pieces that are apart, yet had to share a surface with others
  double objective = 0; ///< what the improvement made small; 0: there was none
  std::vector<CageBox> boxes;                ///< that were united, if any
  std::shared_ptr<const BoxesMade> box_tree; ///< how they were found; null: there are none

  // What it is like.

  double clearance = 0;            ///< that was heeded: no more than asked for; 0: Method::boxes
  std::optional<double> gap;       ///< with max_gap: no point is farther from the model: proved
  std::optional<QuadReport> quads; ///< if there are any
  /// With quads, or where joints were given: closed loops of edges round limbs, where they begin or
  /// bend: vertices in order.
  std::vector<std::vector<Index>> limb_rings;
  std::optional<MirrorPairing> mirror; ///< of a cage that is its own mirror image

  std::vector<Remark> remarks;  ///< what is not as asked for first
  std::vector<StageTime> times; ///< in order

  /// Whether all that was asked for holds.
  [[nodiscard]] bool is_as_asked() const;

  /// What is said for a reason; null: nothing.
  [[nodiscard]] const Remark* find(Reason reason) const;
};

} // namespace cagewright
