/// \file
/// The judge: is this a valid cage of this model?
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

namespace cagewright {

/// Everything that can be wrong with a cage. "Places" says what Violation::elements holds.
enum class ViolationKind {
  no_faces,            ///< the cage has no usable face. Places: none
  bad_corner,          ///< a face of fewer than three corners, or with one that is no vertex: face
  not_finite,          ///< a coordinate is infinite or not a number: vertex
  unused_vertex,       ///< no face uses it: vertex
  coincident_vertices, ///< two used vertices at exactly the same position: vertex, vertex
  degenerate_face,     ///< names a vertex twice, or a triangle of it has no area: face
  folded_face,         ///< meets itself, along one of its diagonals at least: face
  duplicate_face,      ///< has the corners of an earlier one, in any order: face
  open_edge,           ///< an edge of one face only: vertex, vertex
  t_junction,          ///< a vertex on an open edge of a face that does not have it: vertex, face
  nonmanifold_edge,    ///< an edge of three or more faces: vertex, vertex
  flipped_edge,        ///< two neighbors run along it the same way, one is flipped: vertex, vertex
  nonmanifold_vertex,  ///< its faces touch in this point only: vertex
  self_intersection,   ///< two faces cross or touch where they share nothing: face, face
  inverted_piece,      ///< a closed piece oriented inward: a face of it
  several_pieces,      ///< a second, third... piece, where one is allowed: a face of it
  nested_piece,        ///< a closed piece within another: a face of it
  vertex_outside,      ///< not inside the cage: model vertex
  vertex_on_cage,      ///< exactly on a face of the cage: model vertex, face
  face_contact,        ///< cross or touch: model face, cage face
};

constexpr std::size_t violation_kinds = static_cast<std::size_t>(ViolationKind::face_contact) + 1;

/// The kind's name as it stands in JSON, such as "open_edge".
std::string_view name_of(ViolationKind kind);

/// One violation, with its place.
struct Violation {
  static constexpr Index none = std::numeric_limits<Index>::max();

  ViolationKind kind = ViolationKind::no_faces;
  /// Indices of vertices or faces, from 0, as the kind says; `none` where there are fewer than two.
  std::array<Index, 2> elements = {none, none};
  Vec3 place = Vec3::Zero(); ///< a point of what is wrong
};

struct ValidateOptions {
  /// Accept a cage of several closed pieces, none within another.
  bool allow_pieces = false;
  /// Accept closed pieces within others, where they are oriented inward. What they enclose counts
  /// as inside the cage, too.
  bool allow_inner_shells = false;
  /// Judge vertices at exactly equal positions as one, as many exporters split them, and leave out
  /// vertices that no face uses; the report counts both. Elements of violations are then the first
  /// vertices at their positions.
  bool weld = false;
  /// How many violations of each kind are listed; all are counted.
  std::size_t max_listed = 20;
  /// Stop after the first check that fails: for those who only ask whether the cage is valid. The
  /// counts are then those of the checks that were made.
  bool first_only = false;
};

struct ValidityReport {
  std::array<std::size_t, violation_kinds> counts = {}; ///< by kind
  std::vector<Violation> violations; ///< by kind, at most max_listed of each, in a fixed order
  /// The cage is not closed, so that "inside" is not defined: vertex_outside was then judged by the
  /// generalized winding number, in doubles.
  bool containment_approximate = false;

  std::size_t merged_vertices = 0;      ///< of the cage, by ValidateOptions::weld
  std::size_t loose_vertices = 0;       ///< of the cage, left out by ValidateOptions::weld
  std::size_t loose_model_vertices = 0; ///< of no triangle of the model: they are not judged

  [[nodiscard]] bool valid() const;
  [[nodiscard]] std::size_t count(ViolationKind kind) const {
    return counts[static_cast<std::size_t>(kind)];
  }
};

/// Judges a cage: closed, edge- and vertex-manifold, consistently oriented outward, without
/// degenerate faces, unused vertices or self-intersections, in one piece; every model vertex of a
/// triangle strictly inside (of a model without triangles, every vertex); no model face touching a
/// cage face.
///
/// All of it is decided exactly on the coordinates as they are. Faces that share corners by index
/// or by position may touch there and nowhere else. A quad must pass under both of its diagonals:
/// whichever a program cuts it along, the cage is valid. Larger faces are judged as triangulate()
/// cuts them. Containment is decided by signed crossings of rays, one ray for each part of the
/// model that hangs together without touching the cage. Model coordinates that are not finite are
/// outside.
///
/// \param cage   C vertices, F faces
/// \param model  V vertices, T triangles
///
/// Errors: cancelled.
/// Cost: O((F + T) log F) time unless a great many faces touch; parallel.
Result<ValidityReport> validate_cage(const PolygonMesh& cage, TriangleView model,
                                     const ValidateOptions& options = {},
                                     const Progress& progress = {});

/// The same for a cage of triangles.
Result<ValidityReport> validate_cage(TriangleView cage, TriangleView model,
                                     const ValidateOptions& options = {},
                                     const Progress& progress = {});

/// True when the mesh alone passes: closed, manifold, consistently oriented outward, no degenerate
/// face, no unused vertex, no self-intersection. Several pieces are accepted, none within another.
/// Exact.
bool is_embedded(TriangleView mesh);

} // namespace cagewright
