/// \file
/// What is next to what in a cage.
#pragma once

#include "mesh/topology.h"
#include <cagewright/mesh/polygon_mesh.h>

#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

/// The lists of a table of lists, one after the other.
class IndexLists {
public:
  IndexLists() = default;
  /// From pairs (list, item); each list keeps the order of its items.
  IndexLists(std::size_t count, std::span<const std::array<Index, 2>> pairs);

  [[nodiscard]] std::span<const Index> operator[](std::size_t list) const {
    return std::span(items_).subspan(begins_[list], begins_[list + 1] - begins_[list]);
  }
  [[nodiscard]] std::size_t size() const { return begins_.size() - 1; }

private:
  std::vector<Index> items_;
  std::vector<std::size_t> begins_ = {0};
};

/// The vertices, edges and faces round each other, of any mesh: a cage that is loaded may be open
/// or worse. Edges are numbered in rising order of their vertices, the lower first.
///
/// Cost: O(C log C) for C corners.
class CageGraph {
public:
  CageGraph() = default;
  explicit CageGraph(const PolygonMesh& cage);

  [[nodiscard]] std::size_t vertex_count() const { return vertex_edges_.size(); }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }
  [[nodiscard]] std::size_t face_count() const { return face_edges_.size(); }

  [[nodiscard]] std::span<const EdgeVertices> edges() const { return edges_; }
  [[nodiscard]] const EdgeVertices& edge(Index e) const { return edges_[e]; }
  /// The edge between two vertices, in either order.
  [[nodiscard]] std::optional<Index> find_edge(Index a, Index b) const;

  [[nodiscard]] std::span<const Index> vertex_edges(Index v) const { return vertex_edges_[v]; }
  [[nodiscard]] std::span<const Index> vertex_faces(Index v) const { return vertex_faces_[v]; }
  [[nodiscard]] std::span<const Index> edge_faces(Index e) const { return edge_faces_[e]; }
  /// Edge k of a face goes from its corner k to the next.
  [[nodiscard]] std::span<const Index> face_edges(Index f) const { return face_edges_[f]; }
  [[nodiscard]] std::span<const Index> face_vertices(Index f) const { return face_vertices_[f]; }

  [[nodiscard]] Index other_end(Index e, Index v) const {
    return edges_[e][0] == v ? edges_[e][1] : edges_[e][0];
  }

  /// The edge that goes on straight from edge e through its end v: the opposite one of 4 or 6
  /// edges that lie round v in a circle of faces. None elsewhere.
  [[nodiscard]] std::optional<Index> straight_on(Index e, Index v) const;
  /// The edge opposite to e in a quad.
  [[nodiscard]] std::optional<Index> across(Index e, Index quad) const;

private:
  std::vector<EdgeVertices> edges_;
  IndexLists vertex_edges_, vertex_faces_, edge_faces_, face_edges_, face_vertices_;
};

} // namespace cagewright::app
