/// \file
/// A dirty surface taken apart into oriented patches.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace cagewright {

/// The distinct triangles of a mesh, turned so that neighbours agree.
struct SurfacePatches {
  std::vector<Triangle> triangles; ///< T' <= T, over the mesh's positions
  std::vector<std::int32_t> patch; ///< T' indices of patches
  std::vector<bool> closed;        ///< of each patch: no open or non-manifold edge, orientable
  [[nodiscard]] bool all_closed() const;
};

/// Corners at equal positions are one. Triangles with a repeated corner are dropped, and of several
/// with the same three corners all but the first. Two triangles belong to the same patch if they
/// share an edge that no third one uses, and are then turned to run along it in opposite
/// directions; which triangle of a patch keeps its own orientation is settled by majority. Closed
/// patches are turned outward: their volume is positive.
///
/// Cost: O(T) for T triangles.
SurfacePatches surface_patches(TriangleView mesh);

} // namespace cagewright
