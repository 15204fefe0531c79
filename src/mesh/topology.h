/// \file
/// How the faces of a mesh hang together, as their vertex indices say.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace cagewright {

using EdgeVertices = std::array<Index, 2>;

/// What topology() found. Vertices are told apart by index: to judge by position, weld() first.
/// Faces that name a vertex twice are listed and otherwise ignored. Every list is sorted.
struct TopologyReport {
  std::size_t used_vertices = 0; ///< vertices that some face uses
  std::size_t edges = 0;

  std::vector<EdgeVertices> boundary_edges;     ///< edges of one face, directed as the face runs
  std::vector<EdgeVertices> nonmanifold_edges;  ///< edges of three or more faces; lower index first
  std::vector<EdgeVertices> inconsistent_edges; ///< edges that two faces run along the same way
  std::vector<Index>
      nonmanifold_vertices; ///< vertices whose faces do not all hang together by edges
  std::vector<Index> unused_vertices;
  std::vector<Index> repeated_corner_faces; ///< faces that name a vertex twice
  std::vector<Index>
      duplicate_faces; ///< faces with the same corners, in any order, as an earlier one

  std::size_t boundary_loops = 0;       ///< connected runs of boundary edges
  std::size_t components = 0;           ///< parts connected by vertices
  std::vector<Index> component_of_face; ///< F labels < components, by the first face of each
  /// Sum of the components' genera, boundary loops thought capped; none for a non-manifold mesh.
  /// Half of what it is for the orientable cover when the surface is not orientable.
  std::optional<long> genus;

  [[nodiscard]] bool is_closed() const { return boundary_edges.empty() && edges > 0; }
  [[nodiscard]] bool is_manifold() const {
    return nonmanifold_edges.empty() && nonmanifold_vertices.empty();
  }
  [[nodiscard]] bool is_oriented() const { return inconsistent_edges.empty(); }
};

/// Cost: O(F log F) time, in practice O(F).
TopologyReport topology(TriangleView mesh);

/// The same for polygons; faces of fewer than three corners count as naming a vertex twice.
TopologyReport topology(const PolygonMesh& mesh);

} // namespace cagewright
