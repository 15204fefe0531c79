/// \file
/// A closed triangle mesh that changes: faces are taken out and put in, patch by patch. It may be
/// held as one half of itself.
#pragma once

#include "improve/cage_extent.h"
#include "improve/seam_band.h"
#include "spatial/surface_tree.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cagewright {

inline constexpr Index no_index = ~Index{0};

/// The mirror image of a face, turned so that it faces outward again; the corners keep their places
/// but for the last two, which change them.
inline Corners mirrored(const Corners& t) {
  return {mirrored(t[0]), mirrored(t[2]), mirrored(t[1])};
}

/// Some faces of a cage and those that take their place. At most one vertex is new or moves.
struct Patch {
  std::vector<Index> removed;
  std::vector<Triangle> added;
  Index vertex = no_index; ///< the vertex that gets a new position, or the next free index
  bool on_plane = false;   ///< that vertex is one of a half's on its plane
  Vec3 position = Vec3::Zero();
  Index gone = no_index; ///< the vertex that no face uses any more
};

/// Edges of a seam, at least: of a whole cage. So many can be the border of a quad.
inline constexpr std::size_t least_seam = 4;

/// The directed edges (a, b) round a patch to be filled by the triangles (vertex, a, b), in order.
using Ring = std::vector<std::array<Index, 2>>;

/// Vertices and faces keep their numbers while they live; numbers of the dead are not reused.
///
/// Its faces may belong to parts. The edges between two parts, the seams, are then loops, no two of
/// which have a vertex in common, and so it stays: changes that would tear a seam, pinch it, make
/// it shorter than `least_seam` edges, or join it to another are not offered. A seam may have a
/// band that its vertices are to stay in.
class CageMesh {
public:
  /// \param parts  that the faces belong to; empty: all to one
  /// \param bands  by part: of the seam between it and parts of smaller numbers; or empty
  explicit CageMesh(TriangleView mesh, CageExtent extent = CageExtent::whole,
                    std::span<const Index> parts = {}, std::span<const SeamBand> bands = {});

  [[nodiscard]] bool is_half() const { return extent_ == CageExtent::half; }

  /// Vertices of the whole cage: of a half those off the plane count twice.
  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  /// Faces that are held: of a half, not of the whole.
  [[nodiscard]] std::size_t face_count() const { return face_count_; }
  [[nodiscard]] Index vertex_end() const { return static_cast<Index>(positions_.size()); }
  [[nodiscard]] Index face_end() const { return static_cast<Index>(faces_.size()); }

  [[nodiscard]] const Vec3& position(Index v) const { return positions_[v]; }
  [[nodiscard]] const Triangle& face(Index f) const { return faces_[f]; }
  [[nodiscard]] bool has_face(Index f) const { return faces_[f][0] != no_index; }
  [[nodiscard]] bool has_vertex(Index v) const { return !around_[v].empty(); }
  /// The faces at v, in no special order.
  [[nodiscard]] const std::vector<Index>& around(Index v) const { return around_[v]; }
  /// Whether v is one of a half's vertices on the plane x = 0, where it has to stay.
  [[nodiscard]] bool on_plane(Index v) const { return on_plane_[v] != 0; }
  /// The same once the patch is made.
  [[nodiscard]] bool on_plane(const Patch& patch, Index v) const {
    return v == patch.vertex ? patch.on_plane : on_plane(v);
  }
  /// For how many vertices of the whole cage v stands: one on the plane, two off it.
  [[nodiscard]] std::size_t copies(Index v) const { return is_half() && !on_plane(v) ? 2 : 1; }
  /// For how many faces at v in the whole cage one face at v stands.
  [[nodiscard]] std::size_t sides(Index v) const { return on_plane(v) ? 2 : 1; }
  /// The faces at v in the whole cage.
  [[nodiscard]] std::size_t valence(Index v) const { return sides(v) * around_[v].size(); }

  /// The neighbours of v, each once.
  [[nodiscard]] std::vector<Index> neighbors(Index v) const;

  /// The face to the left of the directed edge a b, or no_index.
  [[nodiscard]] Index face_left_of(Index a, Index b) const;

  [[nodiscard]] bool has_edge(Index a, Index b) const {
    return face_left_of(a, b) != no_index || face_left_of(b, a) != no_index;
  }

  /// The part that face f belongs to.
  [[nodiscard]] Index part(Index f) const { return parts_.empty() ? 0 : parts_[f]; }

  /// The band of the seam that v is on, or null.
  [[nodiscard]] const SeamBand* band_of(Index v) const;
  /// The band that the patch's vertex has to be in, or null.
  [[nodiscard]] const SeamBand* band_of(const Patch& patch) const;

  /// The corner of face f that is neither a nor b.
  [[nodiscard]] Index corner_opposite(Index f, Index a, Index b) const;

  /// v moved to p.
  [[nodiscard]] Patch move(Index v, const Vec3& p) const;

  /// v merged into u, or u into v if only v is on the plane. None if the result would not be
  /// manifold (the link condition: u and v have more common neighbours than the edge has faces, or
  /// the mesh is a tetrahedron), or not the half of a manifold mesh, or lose a seam.
  [[nodiscard]] std::optional<Patch> collapse(Index u, Index v) const;

  /// The edge a b of two triangles exchanged for the other diagonal. None if that exists already,
  /// if the edge has one triangle only, or if it is of a seam.
  [[nodiscard]] std::optional<Patch> flip(Index a, Index b) const;

  /// A new vertex on the edge a b, which is on the plane if the edge is.
  [[nodiscard]] Patch split(Index a, Index b) const;

  /// Makes the change; a vertex on the plane must stay there. \returns the new faces' numbers, in
  /// the order of `added`.
  std::vector<Index> apply(const Patch& patch);

  /// Moves a vertex and nothing else. One on the plane stays there.
  void set_position(Index v, const Vec3& p) {
    assert(!on_plane(v) || p.x() == 0);
    positions_[v] = p;
  }

  /// The living, renumbered in order.
  [[nodiscard]] TriangleMesh compact() const;
  /// The parts of its faces, in the same order.
  [[nodiscard]] std::vector<Index> compact_parts() const;

private:
  void detach(Index f);
  [[nodiscard]] bool keeps_halves_apart(const Patch& patch) const;
  [[nodiscard]] bool keeps_seams(Index u, Index v) const;
  [[nodiscard]] bool is_on_seam(Index v) const;
  [[nodiscard]] bool is_seam(Index a, Index b) const;
  [[nodiscard]] std::size_t seam_length(Index a, Index b) const;
  [[nodiscard]] std::vector<Index> parts_after(const Patch& patch) const;

  CageExtent extent_;
  std::vector<Vec3> positions_;
  std::vector<std::uint8_t> on_plane_;
  std::vector<Triangle> faces_;
  std::vector<Index> parts_; // of the faces; empty: all one
  std::vector<SeamBand> bands_;
  std::vector<std::vector<Index>> around_;
  std::size_t vertex_count_ = 0;
  std::size_t face_count_ = 0;
};

/// The faces across the edges of a half's boundary are mirror images: this is the face to the left
/// of a b, which may be one. `from` has the corners of the face to the right.
Corners corners_across(const CageMesh& cage, const Corners& from, Index a, Index b);

/// The corners of a living face.
Corners corners_of(const CageMesh& cage, Index face);

/// The directed edges opposite to `vertex` in the patch's new faces, in order round it: a cycle, or
/// a chain if the vertex is on a half's boundary.
Ring ring_of(const Patch& patch);

} // namespace cagewright
