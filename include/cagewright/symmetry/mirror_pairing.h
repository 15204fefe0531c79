/// \file
/// A mirror plane, and which parts of a cage are each other's mirror images in it.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// The plane normal . x = offset, and how far a model is from being its own mirror image in it.
struct MirrorPlane {
  Vec3 normal = Vec3::UnitX(); ///< length one; the component of greatest magnitude is positive
  double offset = 0;           ///< in the model's units
  /// Distances of the mirror image of the model's surface to the surface, in diagonals of the
  /// model's box: the mean over the surface, and what one point in a hundred exceeds.
  double mean_error = 0;
  double high_error = 0;

  /// 0, 1 or 2 if the normal is exactly the axis x, y or z; otherwise -1.
  [[nodiscard]] int axis() const;
  [[nodiscard]] Vec3 mirrored(const Vec3& p) const {
    return p - 2 * (normal.dot(p) - offset) * normal;
  }
};

/// How the parts of a cage are paired.
struct MirrorPairing {
  /// False: faces and vertices are paired, but positions are not mirror images, because the model
  /// is in a pose. The plane is that of a symmetric pose, about in the middle, and has no errors.
  bool in_plane = true;
  MirrorPlane plane;
  std::vector<Index> vertex_partners; ///< of each vertex; on the plane, or in the middle, itself
  std::vector<Index> face_partners;   ///< of each face
  /// The greatest distance of a vertex from the mirror image of its partner, in the model's units:
  /// 0 for planes across one of the world's axes.
  double error = 0;
};

} // namespace cagewright
