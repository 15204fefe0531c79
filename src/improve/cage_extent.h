/// \file
/// Cages that are their own mirror images are improved by halves.
#pragma once

#include <cagewright/core/geometry.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace cagewright {

/// Whether a mesh is the whole cage, or the half at x >= 0 of one that is its own mirror image.
///
/// A half is open, its boundary lies on the plane x = 0 exactly, and all its other vertices have
/// x > 0. No face lies in the plane, and no edge of two faces joins two vertices of the plane:
/// joined to its mirror image it would be an edge of four. So the whole is closed and manifold.
enum class CageExtent { whole, half };

/// The vertices of the whole cage: those of a half count twice unless they are on the plane.
inline std::size_t whole_vertices(std::span<const Vec3> positions, CageExtent extent) {
  if (extent == CageExtent::whole) {
    return positions.size();
  }
  const auto on_plane =
      std::count_if(positions.begin(), positions.end(), [](const Vec3& p) { return p.x() == 0; });
  return 2 * positions.size() - static_cast<std::size_t>(on_plane);
}

/// The mirror image in the plane x = 0.
inline Vec3 mirrored(const Vec3& p) {
  return {-p.x(), p.y(), p.z()};
}

} // namespace cagewright
