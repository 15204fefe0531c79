/// \file
/// Normals that make a faceted mesh look smooth and leave its creases sharp.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// A unit normal for each corner of each triangle: 3 T, in the order of the triangles.
///
/// Triangles round a vertex share a normal, weighted by their angles there, as long as one can walk
/// from one to the next over edges that bend by less than `crease_degrees`. Points at the same
/// place count as one. A triangle without area, and alone, gets a zero normal. O(V log V + T log
/// T).
std::vector<Eigen::Vector3f> smooth_normals(TriangleView mesh, double crease_degrees);

} // namespace cagewright
