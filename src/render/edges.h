/// \file
/// The lines and points of a mesh that a picture shows.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>

#include <utility>
#include <vector>

namespace cagewright {

/// For each of the points, the first one at exactly the same place: V indices. Files without
/// shared vertices (STL) become connected this way. O(V log V).
std::vector<Index> merged_points(std::span<const Vec3> positions);

/// The sides of all polygons, each once, as pairs of vertices; points at the same place count as
/// one. No diagonals of triangulations. Sides where exactly two polygons meet that bend by less
/// than `least_bend_degrees` are left out: of a union of boxes, what the boxes do not show.
/// O(C log C) for C corners.
std::vector<std::pair<Index, Index>> polygon_edges(const PolygonMesh& mesh,
                                                   double least_bend_degrees = 0);

/// The vertices that the edges use, in order.
std::vector<Index> end_points(const std::vector<std::pair<Index, Index>>& edges);

/// The vertices that faces use, each place once.
std::vector<Index> used_points(const PolygonMesh& mesh);

} // namespace cagewright
