/// \file
/// A cage of triangles and quads that changes: faces are taken out and put in.
#pragma once

#include "improve/cage_mesh.h"
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// A triangle or a quad, counter-clockwise from outside.
struct CageFace {
  std::array<Index, 4> corners{}; ///< the last one of a triangle means nothing
  int size = 0;                   ///< 3 or 4; 0: there is no such face
  /// A quad that is to be: so far it may be cut along its first diagonal only.
  bool tentative = false;
  Index part = 0; ///< of the cage: the sides between faces of different parts stay

  static CageFace triangle(Index a, Index b, Index c) { return {{a, b, c, no_index}, 3}; }
  static CageFace quad(Index a, Index b, Index c, Index d) { return {{a, b, c, d}, 4}; }

  [[nodiscard]] bool is_quad() const { return size == 4; }
  [[nodiscard]] std::span<const Index> span() const {
    return {corners.data(), static_cast<std::size_t>(size)};
  }
  /// Corner i, counted round: i may be `size` and more.
  [[nodiscard]] Index operator[](int i) const { return corners[i % size]; }
  /// The same quad, begun at another corner.
  [[nodiscard]] CageFace turned(int by) const {
    return {
        {(*this)[by], (*this)[by + 1], (*this)[by + 2], (*this)[by + 3]}, size, tentative, part};
  }
  [[nodiscard]] CageFace of_part(Index p) const { return {corners, size, tentative, p}; }
  [[nodiscard]] bool has(Index v) const {
    for (int i = 0; i < size; ++i) {
      if (corners[i] == v) {
        return true;
      }
    }
    return false;
  }
};

/// The triangles that a program may cut a face into: one of a triangle, four of a quad, two for
/// each diagonal: the first two along the diagonal from corner 0 to 2, the others from 1 to 3. The
/// middle corner of each is a corner of the quad with the two corners beside it.
struct FaceParts {
  std::array<Triangle, 4> triangles;
  int count = 0;

  enum class Of { all, valid }; ///< valid: of a tentative quad only those of its first diagonal
  explicit FaceParts(const CageFace& face, Of which = Of::valid);
  [[nodiscard]] const Triangle* begin() const { return triangles.data(); }
  [[nodiscard]] const Triangle* end() const { return triangles.data() + count; }
};

/// Faces keep their numbers while they live; vertices always. It may have a border: then it is one
/// half of a symmetric cage.
class QuadCage {
public:
  /// \param parts  that the faces belong to; empty: all to one
  /// \param bands  by part: where its border to parts of smaller numbers stays; or empty
  explicit QuadCage(TriangleView mesh, std::span<const Index> parts = {},
                    std::span<const SeamBand> bands = {});
  /// Of triangles and quads.
  explicit QuadCage(const PolygonMesh& mesh);

  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  [[nodiscard]] Index vertex_end() const { return static_cast<Index>(positions_.size()); }
  [[nodiscard]] Index face_end() const { return static_cast<Index>(faces_.size()); }
  [[nodiscard]] const CageFace& face(Index f) const { return faces_[f]; }
  [[nodiscard]] bool has_face(Index f) const { return faces_[f].size != 0; }
  /// The faces at v, in no special order.
  [[nodiscard]] const std::vector<Index>& around(Index v) const { return around_[v]; }
  /// The face to the left of the directed side a b, or no_index.
  [[nodiscard]] Index face_left_of(Index a, Index b) const;
  [[nodiscard]] bool on_border(Index v) const { return on_border_[v] != 0; }
  [[nodiscard]] bool has_border() const { return has_border_; }
  /// Whether just one face has the side between a and b.
  [[nodiscard]] bool is_border(Index a, Index b) const {
    return (face_left_of(a, b) == no_index) != (face_left_of(b, a) == no_index);
  }

  /// The band of the border between parts that v is on, or null.
  [[nodiscard]] const SeamBand* band_of(Index v) const;

  /// Numbers of the new faces follow face_end(). The border does not change.
  void replace(std::span<const Index> removed, std::span<const CageFace> added);

  /// Numbers the faces anew, without gaps.
  void renumber_faces();

  /// The same corners, turned or no longer tentative.
  void set_face(Index f, const CageFace& face) { faces_[f] = face; }

  void set_positions(std::vector<Vec3> positions) { positions_ = std::move(positions); }

  /// All faces, in the order of their numbers, over the vertices that they use, in order.
  [[nodiscard]] PolygonMesh to_polygons() const;
  /// The parts of its faces, in the same order.
  [[nodiscard]] std::vector<Index> parts() const;

private:
  void find_border();

  std::vector<Vec3> positions_;
  std::vector<CageFace> faces_;
  std::vector<std::vector<Index>> around_;
  std::vector<std::uint8_t> on_border_; // by vertex
  std::vector<SeamBand> bands_;
  bool has_border_ = false;
};

} // namespace cagewright
