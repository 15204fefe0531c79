/// \file
/// A closed triangle mesh that changes: faces are taken out and put in, patch by patch.
#pragma once

#include "mesh/triangle_mesh.h"

#include <array>
#include <optional>
#include <vector>

namespace cagewright {

inline constexpr Index no_index = ~Index{0};

/// Some faces of a cage and those that take their place. At most one vertex is new or moves.
struct Patch {
  std::vector<Index> removed;
  std::vector<Triangle> added;
  Index vertex = no_index; ///< the vertex that gets a new position, or the next free index
  Vec3 position = Vec3::Zero();
  Index gone = no_index; ///< the vertex that no face uses any more
};

/// The directed edges (a, b) round a patch to be filled by the triangles (vertex, a, b), in order.
using Ring = std::vector<std::array<Index, 2>>;

/// Vertices and faces keep their numbers while they live; numbers of the dead are not reused.
class CageMesh {
public:
  explicit CageMesh(TriangleView mesh);

  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] std::size_t face_count() const { return face_count_; }
  [[nodiscard]] Index vertex_end() const { return static_cast<Index>(positions_.size()); }
  [[nodiscard]] Index face_end() const { return static_cast<Index>(faces_.size()); }

  [[nodiscard]] const Vec3& position(Index v) const { return positions_[v]; }
  [[nodiscard]] const Triangle& face(Index f) const { return faces_[f]; }
  [[nodiscard]] bool has_face(Index f) const { return faces_[f][0] != no_index; }
  [[nodiscard]] bool has_vertex(Index v) const { return !around_[v].empty(); }
  /// The faces at v, in no special order. Their number is v's valence.
  [[nodiscard]] const std::vector<Index>& around(Index v) const { return around_[v]; }

  /// The neighbours of v, each once.
  [[nodiscard]] std::vector<Index> neighbors(Index v) const;

  /// The face to the left of the directed edge a b, or no_index.
  [[nodiscard]] Index face_left_of(Index a, Index b) const;

  /// The corner of face f that is neither a nor b.
  [[nodiscard]] Index corner_opposite(Index f, Index a, Index b) const;

  /// v moved to p.
  [[nodiscard]] Patch move(Index v, const Vec3& p) const;

  /// v merged into u. None if the result would not be manifold (the link condition: u and v have
  /// more than two common neighbours, or the mesh is a tetrahedron).
  [[nodiscard]] std::optional<Patch> collapse(Index u, Index v) const;

  /// The edge a b of two triangles exchanged for the other diagonal. None if that exists already.
  [[nodiscard]] std::optional<Patch> flip(Index a, Index b) const;

  /// A new vertex on the edge a b.
  [[nodiscard]] Patch split(Index a, Index b) const;

  /// Makes the change. \returns the new faces' numbers, in the order of `added`.
  std::vector<Index> apply(const Patch& patch);

  /// Moves a vertex and nothing else.
  void set_position(Index v, const Vec3& p) { positions_[v] = p; }

  /// The living, renumbered in order.
  [[nodiscard]] TriangleMesh compact() const;

private:
  void detach(Index f);

  std::vector<Vec3> positions_;
  std::vector<Triangle> faces_;
  std::vector<std::vector<Index>> around_;
  std::size_t vertex_count_ = 0;
  std::size_t face_count_ = 0;
};

/// The directed edges opposite to `vertex` in the patch's new faces, in order round it.
Ring ring_of(const Patch& patch);

} // namespace cagewright
