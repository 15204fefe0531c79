/// \file
/// Whether a cage is still valid, at once, while its vertices are dragged.
#pragma once

#include "spatial/bvh.h"
#include "validate/cage_parts.h"
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace cagewright::app {

/// The points of a model by which it is known whether it is inside. O(V + T).
struct WatchedPoints {
  WatchedPoints() = default;
  explicit WatchedPoints(TriangleView model);

  std::vector<Vec3> points; ///< a vertex of each part that hangs together, and all stray ones
  bool is_finite = true;
  double diagonal = 0;
};

/// What a watch needs of a model. Made once for each model, shared, never changed.
struct WatchedModel : WatchedPoints {
  explicit WatchedModel(TriangleView model);
  /// \param hierarchy  over the model's triangles
  WatchedModel(WatchedPoints of_model, std::shared_ptr<const TriangleBvh> hierarchy)
      : WatchedPoints(std::move(of_model)), bvh(std::move(hierarchy)) {}

  std::shared_ptr<const TriangleBvh> bvh;
};

struct WatchOptions {
  bool allow_pieces = false; ///< as in ValidateOptions
};

/// Follows a cage whose vertices move, and whose topology does not. It agrees with validate_cage(),
/// which judges from scratch: by the same exact predicates, applied only to the faces that moved.
///
/// Cost: of a change, O(F log F) for the F faces of the cage, and what lies near the faces that
/// moved; parallel.
class CageWatch {
public:
  CageWatch(PolygonMesh cage, std::shared_ptr<const WatchedModel> model,
            const WatchOptions& options = {});

  [[nodiscard]] const PolygonMesh& cage() const { return cage_; }

  /// Moves vertices and judges anew. One position for each.
  void move(std::span<const Index> vertices, std::span<const Vec3> positions);

  /// Moves vertices straight towards `targets`, as far as the cage stays valid; all the way if it
  /// is not valid to begin with, so that it can be mended. Always ends in a valid state when it
  /// began in one. \returns the fraction of the way, in [0, 1]
  ///
  /// The way is looked at in steps of a fiftieth of the model's diagonal, sixteen at most.
  double advance(std::span<const Index> vertices, std::span<const Vec3> targets);

  /// The same answer as that of validate_cage().
  [[nodiscard]] bool is_valid() const;

  /// Faces that touch the model, cross other faces, or have no area: ascending.
  [[nodiscard]] std::vector<Index> bad_faces() const;
  [[nodiscard]] bool touches_model(Index face) const { return touches_[face] != 0; }
  [[nodiscard]] const std::vector<Index>& crossed_by(Index face) const { return crossed_[face]; }
  /// A point of each part of the model that lies outside.
  [[nodiscard]] const std::vector<Vec3>& points_outside() const { return outside_; }
  [[nodiscard]] bool has_sound_topology() const { return sound_topology_; }

private:
  void judge(const std::vector<Index>& faces);
  [[nodiscard]] bool find_contact(Index face) const;
  [[nodiscard]] std::vector<Index> find_crossings(Index face) const;
  void judge_whole();

  PolygonMesh cage_;
  std::shared_ptr<const WatchedModel> model_;
  WatchOptions options_;
  std::vector<std::vector<Index>> faces_of_; // vertices
  std::vector<Index> piece_of_face_;
  std::size_t pieces_ = 0;
  std::size_t used_vertices_ = 0;
  bool sound_topology_ = false;

  CageParts parts_;
  std::vector<char> touches_;
  std::vector<char> degenerate_;
  std::vector<std::vector<Index>> crossed_; // faces, ascending; both ways
  std::vector<Vec3> outside_;
  bool sound_whole_ = false; // oriented outward, no two vertices in one place, nothing nested
};

} // namespace cagewright::app
