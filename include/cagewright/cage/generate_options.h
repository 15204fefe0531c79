/// \file
/// What can be asked of a cage.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/slicing/slicing_rule.h>

#include <optional>
#include <span>

namespace cagewright {

/// What a cage is made from.
enum class Method {
  envelope,       ///< a surface of voxels, improved: any topology, tight everywhere
  boxes,          ///< the union of oriented boxes round the model's parts, as it is
  boxes_improved, ///< that union, improved
};

/// Whether the cage is to be its own mirror image.
enum class Symmetry {
  off,
  automatic, ///< if the model is, in whatever plane
  x,         ///< in the best plane across this axis, even if the model is not
  y,
  z,
  topology, ///< faces and vertices are paired, but positions are not where the model is in a pose
};

/// What becomes of a model in several pieces.
enum class Pieces {
  together, ///< one cage: thin bridges join the pieces
  apart,    ///< a closed surface for each group of pieces that are apart
};

/// A place where a limb bends: an elbow, a knee.
struct LimbJoint {
  Vec3 position = Vec3::Zero(); ///< within the limb
  Vec3 along = Vec3::Zero();    ///< to where the limb goes on, of any length; zero: not known
};

/// What generate() is asked for. The defaults make the best cage of 100 vertices.
///
/// Lengths are fractions of the diagonal of the model's bounding box.
struct GenerateOptions {
  Method method = Method::envelope;

  // What the cage may have. Method::boxes heeds none of these but `quads`.

  /// At most so many vertices; 0: no limit. Not given: 100, or no limit where `faces` or `max_gap`
  /// is given.
  std::optional<int> vertices = {};
  int faces = 0;      ///< at most so many faces, as they are written (a quad is one); 0: no limit
  double max_gap = 0; ///< the coarsest cage no point of which is farther from the model than this,
                      ///< above the clearance; vertices and faces are limits then. 0: not asked for
  double clearance = 0.002; ///< least distance between cage and model, 1e-6 to 0.5
  bool quads = false;       ///< quads where they can be; the cage is valid along both diagonals
  Symmetry symmetry = Symmetry::automatic;
  Pieces pieces = Pieces::together; ///< heeded by every method
  /// Leaves out tiny pieces far from the rest, and vertices that no face uses: see find_specks().
  /// The cage is made and judged for what remains; heeded by every method, and with `start`.
  bool ignore_specks = false;
  /// Closes openings of the model, so that a dome, a vase or a pipe gets one solid cage instead of
  /// a thin one that goes in and out. `closing` says how wide; 0: all. Figures are those of the
  /// model with its openings closed. Heeded by every method.
  bool solid = false;
  /// Where the cage is to be finer: one weight above 0 for each vertex of the model, or empty:
  /// even. Four times the weight makes edges half as long; ratios beyond 100 count as 100. The view
  /// must live as long as the call. See density.h.
  std::span<const double> density = {};
  /// Where limbs bend: a ring of edges goes round the limb there, of the budget what these rings
  /// need, largest limbs first. Joints about which no ring can go are left out. The view must live
  /// as long as the call.
  std::span<const LimbJoint> joints = {};
  int rounds = 6; ///< how often, at most, vertices are moved to where they pay; fewer is quicker

  /// A cage of one's own, or null. If given its vertices are moved until it is valid and tight, by
  /// hand-made cages that leave parts of the model outside, or after the model was edited; its
  /// faces and the order of its vertices stay. Of the other options `clearance` and `density` are
  /// heeded then. It must live as long as the call.
  const PolygonMesh* start = nullptr;

  // Of the envelope.

  double closing = 0;          ///< holes and gaps narrower than twice this are filled, 0 to 0.5;
                               ///< with `solid` openings that are no wider are closed, 0: all
  int envelope_resolution = 0; ///< voxels along the model's diagonal, 8 to 512; 0: chosen

  // Of the boxes.

  int resolution = 64; ///< voxels along the longest axis of the model's box, 8 to 512
  int depth = 5;       ///< how often a part may be cut in two, 0 to 20
  int max_boxes = 0;   ///< stop at so many boxes, cutting first where it pays most; 0: no limit
  SlicingRule slicing = SlicingRule::volume;
  bool split_parts = true; ///< a box for each connected part of a half; false: for each half
  NoJump no_jump = NoJump::middle; ///< of the published rule
  double min_jump = 0.15;   ///< of the published rule: least clear jump, of the greatest section
  double min_gain = 0.015;  ///< of the volume rule: what a cut must save of the box's volume
  double eta = 1.1;         ///< T1: not cut where least / greatest cross-section is above this, and
                            ///< zeta's test holds too; above 1: never
  double zeta = 1.1;        ///< T2: not cut where shortest / longest edge is above this, and eta's
                            ///< test holds too; above 1: never
  bool registration = true; ///< join the faces of neighbouring boxes where they fit
};

/// The most vertices that these options allow; 0: any number.
int vertex_limit(const GenerateOptions& options);

} // namespace cagewright
