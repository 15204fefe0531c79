#include "app/edit/cage_graph.h"

#include <algorithm>

namespace cagewright::app {

IndexLists::IndexLists(std::size_t count, std::span<const std::array<Index, 2>> pairs) {
  begins_.assign(count + 1, 0);
  for (const auto& [list, item] : pairs) {
    ++begins_[list + 1];
  }
  for (std::size_t i = 0; i < count; ++i) {
    begins_[i + 1] += begins_[i];
  }
  items_.resize(pairs.size());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (const auto& [list, item] : pairs) {
    items_[next[list]++] = item;
  }
}

CageGraph::CageGraph(const PolygonMesh& cage) {
  std::vector<std::array<Index, 2>> face_vertices;
  std::vector<std::array<Index, 2>> vertex_faces;
  const auto faces = static_cast<Index>(cage.face_count());
  for (Index f = 0; f < faces; ++f) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k];
      const Index b = face[(k + 1) % face.size()];
      face_vertices.push_back({f, a});
      vertex_faces.push_back({a, f});
      if (a != b) {
        edges_.push_back({std::min(a, b), std::max(a, b)});
      }
    }
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());

  std::vector<std::array<Index, 2>> face_edges;
  std::vector<std::array<Index, 2>> edge_faces;
  for (Index f = 0; f < faces; ++f) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (const auto e = find_edge(face[k], face[(k + 1) % face.size()])) {
        face_edges.push_back({f, *e});
        edge_faces.push_back({*e, f});
      }
    }
  }
  std::vector<std::array<Index, 2>> vertex_edges;
  for (Index e = 0; e < edges_.size(); ++e) {
    vertex_edges.push_back({edges_[e][0], e});
    vertex_edges.push_back({edges_[e][1], e});
  }
  face_vertices_ = IndexLists(faces, face_vertices);
  vertex_faces_ = IndexLists(cage.positions.size(), vertex_faces);
  face_edges_ = IndexLists(faces, face_edges);
  edge_faces_ = IndexLists(edges_.size(), edge_faces);
  vertex_edges_ = IndexLists(cage.positions.size(), vertex_edges);
}

std::optional<Index> CageGraph::find_edge(Index a, Index b) const {
  const EdgeVertices edge = {std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), edge);
  if (at == edges_.end() || *at != edge) {
    return std::nullopt;
  }
  return static_cast<Index>(at - edges_.begin());
}

std::optional<Index> CageGraph::straight_on(Index e, Index v) const {
  const std::size_t valence = vertex_edges(v).size();
  if ((valence != 4 && valence != 6) || vertex_faces(v).size() != valence) {
    return std::nullopt;
  }
  // Walks round v, from edge to edge over the faces between them.
  Index edge = e;
  Index face = edge_faces(e)[0];
  for (std::size_t step = 0; step < valence / 2; ++step) {
    const std::span<const Index> sides = face_edges(face);
    const auto next = std::find_if(sides.begin(), sides.end(), [&](Index side) {
      return side != edge && (edges_[side][0] == v || edges_[side][1] == v);
    });
    if (next == sides.end() || edge_faces(*next).size() != 2) {
      return std::nullopt;
    }
    edge = *next;
    face = edge_faces(edge)[0] == face ? edge_faces(edge)[1] : edge_faces(edge)[0];
  }
  return edge;
}

std::optional<Index> CageGraph::across(Index e, Index quad) const {
  const std::span<const Index> sides = face_edges(quad);
  if (sides.size() != 4) {
    return std::nullopt;
  }
  const auto at = std::find(sides.begin(), sides.end(), e) - sides.begin();
  return at < 4 ? std::optional(sides[(at + 2) % 4]) : std::nullopt;
}

} // namespace cagewright::app
