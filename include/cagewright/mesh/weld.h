/// \file
/// Merging vertices that have exactly the same position.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <span>
#include <vector>

namespace cagewright {

/// Distinct positions, and where each of the given points went.
struct WeldedPoints {
  std::vector<Vec3> positions;   ///< D distinct positions, in the order of their first appearance
  std::vector<Index> point_of;   ///< for each of the P points, its place among the D
  std::vector<Index> first_with; ///< for each of the D, the first of the P points that has it
};

/// Merges exactly equal positions (0 and -0 are equal, NaN equals nothing).
///
/// \param positions  P points
/// Cost: O(P).
WeldedPoints weld_points(std::span<const Vec3> positions);

/// The mesh over the distinct positions among its vertices. No triangle is dropped, so that some
/// may name a vertex twice.
TriangleMesh weld(TriangleView mesh);

/// The same for polygons: positions and faces, without colors and groups.
PolygonMesh weld(const PolygonMesh& mesh);

} // namespace cagewright
