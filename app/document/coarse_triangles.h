/// \file
/// A large model with few triangles, for pictures that move.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <vector>

namespace cagewright::app {

/// About `wanted` triangles of some of the mesh's own vertices, so that they follow when these
/// move: space is cut in cubes, and the vertices in each become the one nearest to their mean
/// (Rossignac and Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993).
/// None when the mesh has no more than that itself.
///
/// Cost: O(V log V + T).
std::vector<Triangle> coarse_triangles(TriangleView mesh, std::size_t wanted);

} // namespace cagewright::app
