/// \file
/// Cages that are their own mirror images are improved by halves.
#pragma once

#include "core/geometry.h"

namespace cagewright {

/// Whether a mesh is the whole cage, or the half at x >= 0 of one that is its own mirror image.
///
/// A half is open, its boundary lies on the plane x = 0 exactly, and all its other vertices have
/// x > 0. No face lies in the plane, and no edge of two faces joins two vertices of the plane:
/// joined to its mirror image it would be an edge of four. So the whole is closed and manifold.
enum class CageExtent { whole, half };

/// The mirror image in the plane x = 0.
inline Vec3 mirrored(const Vec3& p) {
  return {-p.x(), p.y(), p.z()};
}

} // namespace cagewright
