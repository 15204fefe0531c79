#include "app/edit/hidden.h"

#include <algorithm>

namespace cagewright::app {
namespace {

/// One for each face that is selected, or lies round what is selected.
std::vector<char> touched_faces(const Selection& selection, const CageGraph& graph) {
  std::vector<char> touched(graph.face_count(), 0);
  const auto touch = [&](std::span<const Index> faces) {
    for (const Index f : faces) {
      touched[f] = 1;
    }
  };
  touch(selection.faces);
  for (const EdgeVertices& edge : selection.edges) {
    if (const std::optional<Index> e = graph.find_edge(edge[0], edge[1])) {
      touch(graph.edge_faces(*e));
    }
  }
  for (const Index v : selection.vertices) {
    touch(graph.vertex_faces(v));
  }
  return touched;
}

std::vector<Index> numbers_of(const std::vector<char>& flags, char value) {
  std::vector<Index> numbers;
  for (Index f = 0; f < flags.size(); ++f) {
    if (flags[f] == value) {
      numbers.push_back(f);
    }
  }
  return numbers;
}

} // namespace

InSight::InSight(const CageGraph& graph, std::span<const Index> hidden_faces) {
  if (hidden_faces.empty()) {
    return;
  }
  faces_.assign(graph.face_count(), 1);
  for (const Index f : hidden_faces) {
    if (f < faces_.size()) {
      faces_[f] = 0;
    }
  }
  const auto any_in_sight = [&](std::span<const Index> faces) {
    const bool any = std::any_of(faces.begin(), faces.end(), [&](Index f) { return face(f); });
    return static_cast<char>(any ? 1 : 0);
  };
  edges_.resize(graph.edge_count());
  for (Index e = 0; e < edges_.size(); ++e) {
    edges_[e] = any_in_sight(graph.edge_faces(e));
  }
  vertices_.resize(graph.vertex_count());
  for (Index v = 0; v < vertices_.size(); ++v) {
    vertices_[v] = any_in_sight(graph.vertex_faces(v));
  }
}

Selection in_sight(const Selection& selection, const CageGraph& graph, const InSight& sight) {
  Selection seen = selection;
  if (!sight.everything()) {
    std::erase_if(seen.vertices, [&](Index v) { return !sight.vertex(v); });
    std::erase_if(seen.faces, [&](Index f) { return !sight.face(f); });
    std::erase_if(seen.edges, [&](const EdgeVertices& edge) {
      const std::optional<Index> e = graph.find_edge(edge[0], edge[1]);
      return !e || !sight.edge(*e);
    });
  }
  return seen;
}

std::vector<Index> hidden_with(const Selection& selection, const CageGraph& graph,
                               std::span<const Index> hidden_faces) {
  std::vector<char> hidden = touched_faces(selection, graph);
  for (const Index f : hidden_faces) {
    if (f < hidden.size()) {
      hidden[f] = 1;
    }
  }
  return numbers_of(hidden, 1);
}

std::vector<Index> hidden_but(const Selection& selection, const CageGraph& graph) {
  return numbers_of(touched_faces(selection, graph), 0);
}

} // namespace cagewright::app
