/// \file
/// The left and the right of a surface that is not its own mirror image, because it is in a pose.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/symmetry/mirror_pairing.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {

struct SurfacePoint {
  Index triangle = 0;
  std::array<double, 3> weights{}; ///< of its corners: at least 0, the sum is 1

  [[nodiscard]] Vec3 in(const std::vector<Vec3>& positions,
                        const std::vector<Triangle>& triangles) const {
    const Triangle& t = triangles[triangle];
    return weights[0] * positions[t[0]] + weights[1] * positions[t[1]] +
           weights[2] * positions[t[2]];
  }
};

/// The point of a triangle as one of its surface.
SurfacePoint surface_point_of(const Vec3& p, Index triangle, const Vec3 (&corners)[3]);

/// A map of a surface to itself that turns left into right.
struct PosedReflection {
  /// In which the surface, brought into a symmetric pose, is its own mirror image. Only the plane:
  /// its errors are not known.
  MirrorPlane plane;
  std::vector<SurfacePoint> images; ///< of each vertex
  /// By how much distances along the surface differ from those between the images: the mean, over
  /// that of the distances.
  double stretch = 0;
  /// How far a point is from the image of its image, in diagonals: the mean.
  double return_error = 0;
  /// How much of the surface has no image near it, as a share of its vertices: an arm whose partner
  /// is missing.
  double uncovered = 0;

  /// Why this is no symmetry of the surface, but only a map that was bent until it fitted: a part
  /// of a sentence. Empty: it is one.
  [[nodiscard]] std::string why_not() const;
  [[nodiscard]] bool is_convincing() const { return why_not().empty(); }
};

/// The best map that there is. The mirror image of the surface is laid onto the surface, bent as
/// little as that takes: the ends of its limbs (limb_tips.h) are drawn to ends of limbs that are as
/// far from each other along the surface, then every place to the nearest that faces the same way
/// (non-rigid registration by closest points; Amberg, Romdhani and Vetter, "Optimal step nonrigid
/// ICP algorithms for surface registration", 2007, with the net of rigid_net.h). Of several ways to
/// pair the ends, and of mirror planes across the axes, the one that stretches the surface least is
/// taken.
///
/// \param surface  closed, connected, manifold, oriented outward; about a thousand vertices of
///                 roughly equal distances are enough
/// \returns none if it is to stop
/// Cost: that of SurfaceDistances, and some 60 sparse factorisations for each of ten maps at most.
std::optional<PosedReflection> find_posed_reflection(const TriangleMesh& surface,
                                                     const Progress& progress = {});

} // namespace cagewright
