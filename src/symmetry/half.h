/// \file
/// One half of a model or of a cage, and back: how a cage becomes its own mirror image.
///
/// Everything is done to the half at x >= 0 in coordinates where the mirror plane is x = 0; the
/// whole is made of it last.
#pragma once

#include "symmetry/mirror_plane.h"
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/symmetry/mirror_pairing.h>

#include <array>
#include <optional>
#include <vector>

namespace cagewright {

/// Coordinates in which a mirror plane is x = 0. They are the model's own, turned and shifted: of a
/// plane across one of the world's axes, shifted along that axis only.
class MirrorFrame {
public:
  MirrorFrame() = default;

  /// \param box  of the model
  MirrorFrame(const MirrorPlane& plane, const Box3& box);

  /// The plane: its offset may have been rounded by a few units in the last place of the largest
  /// coordinate, so that pairs can be exact.
  [[nodiscard]] const MirrorPlane& plane() const { return plane_; }

  [[nodiscard]] Vec3 to_frame(const Vec3& p) const;

  /// The point and its mirror image in the model's coordinates.
  ///
  /// Across one of the world's axes the pair is exact: with c the plane's offset they are c + d and
  /// c - d, both without rounding, and equal in the other two coordinates. (d is p.x() rounded by
  /// at most a unit in the last place of the largest coordinate.) For other planes both are
  /// rounded. A point with x = 0 and its image are the same; across one of the world's axes it lies
  /// on the plane exactly.
  [[nodiscard]] std::array<Vec3, 2> from_frame(const Vec3& p) const;

private:
  MirrorPlane plane_;
  int axis_ = 0;    // -1: none of the world's
  double unit_ = 0; // coordinates along the axis are multiples of it; 0: as they are
  Vec3 origin_ = Vec3::Zero();
  Mat3 axes_ = Mat3::Identity();
};

/// What half a cage must enclose, in the frame: the model's triangles and their mirror images, of
/// both those that reach to x >= 0, and vertices without a triangle.
struct HalfModel {
  TriangleMesh mesh;
  std::vector<Index> vertices; ///< of each vertex the model's that it is, or is the image of
};

HalfModel half_model(TriangleView model, const MirrorFrame& frame);

/// The mirror image of a model: as many vertices and triangles, in the same order.
TriangleMesh mirror_image(TriangleView model, const MirrorPlane& plane);

/// The whole model in the frame.
TriangleMesh in_frame(TriangleView model, const MirrorFrame& frame);

/// The half at x >= 0 of a cage, with the frame that says where the rest is. Open; its boundary
/// lies on x = 0 exactly, and everything else at x > 0.
struct HalfCage {
  TriangleMesh mesh;
  MirrorFrame frame;
};

/// The part at x >= 0 of a closed surface in the frame, cut by the plane. Of several pieces it is
/// the one of the greatest volume. None if the plane does not cut the surface.
std::optional<TriangleMesh> cut_half(TriangleView surface);

template <class Mesh> struct Whole {
  Mesh mesh;
  MirrorPairing pairing;
};

/// The half and its mirror image in the model's coordinates: first the vertices of the half in
/// their order, then the images of those off the plane; first the faces of the half, then theirs.
Whole<TriangleMesh> join_halves(const TriangleMesh& half, const MirrorFrame& frame);
Whole<PolygonMesh> join_halves(const PolygonMesh& half, const MirrorFrame& frame);

} // namespace cagewright
