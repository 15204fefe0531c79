/// \file
/// Polygons to triangles.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// A polygon mesh cut into triangles, and where each came from.
struct Triangulation {
  std::vector<Triangle> triangles; ///< T triangles over the polygon mesh's own vertices
  std::vector<Index> face_of;      ///< T indices of the faces they were cut from
};

/// Cuts every face into triangles over the same vertices.
///
/// A quad a b c d is cut along a c, unless it is concave at b or d: then along b d. Larger faces
/// are cut by ear clipping in their best-fitting plane; a face that crosses itself is cut into a
/// fan. A face of n corners gives n - 2 triangles, whatever its shape, in a fixed order.
///
/// Cost: O(n^2) for a face of n corners.
Triangulation triangulate(const PolygonMesh& mesh);

/// The triangles of triangulate(), with a copy of the positions.
TriangleMesh to_triangle_mesh(const PolygonMesh& mesh);

} // namespace cagewright
