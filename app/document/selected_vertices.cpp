#include "app/document/selected_vertices.h"

#include <algorithm>

namespace cagewright::app {

std::vector<Index> selected_vertices(const Selection& selection, const PolygonMesh& cage) {
  std::vector<Index> vertices = selection.vertices;
  for (const EdgeVertices& edge : selection.edges) {
    vertices.insert(vertices.end(), edge.begin(), edge.end());
  }
  for (const Index f : selection.faces) {
    const auto corners = cage.face(f);
    vertices.insert(vertices.end(), corners.begin(), corners.end());
  }
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::optional<Selection> selection_at(const Violation& violation, const PolygonMesh& cage) {
  const auto [a, b] = violation.elements;
  Selection found;
  const auto add_face = [&](Index f) {
    found.mode = SelectionMode::face;
    if (f < cage.face_count()) {
      found.faces.push_back(f);
    }
  };
  switch (violation.kind) {
  case ViolationKind::no_faces:
  case ViolationKind::vertex_outside:
    return std::nullopt;
  case ViolationKind::not_finite:
  case ViolationKind::unused_vertex:
  case ViolationKind::coincident_vertices:
  case ViolationKind::nonmanifold_vertex:
    for (const Index v : {a, b}) {
      if (v < cage.positions.size()) {
        found.vertices.push_back(v);
      }
    }
    break;
  case ViolationKind::t_junction:
    if (a < cage.positions.size()) {
      found.vertices.push_back(a);
    }
    break;
  case ViolationKind::open_edge:
  case ViolationKind::nonmanifold_edge:
  case ViolationKind::flipped_edge:
    found.mode = SelectionMode::edge;
    if (std::max(a, b) < cage.positions.size()) {
      found.edges.push_back({std::min(a, b), std::max(a, b)});
    }
    break;
  case ViolationKind::vertex_on_cage:
  case ViolationKind::face_contact:
    add_face(b);
    break;
  case ViolationKind::self_intersection:
    add_face(std::min(a, b));
    add_face(std::max(a, b));
    break;
  case ViolationKind::bad_corner:
  case ViolationKind::degenerate_face:
  case ViolationKind::folded_face:
  case ViolationKind::duplicate_face:
  case ViolationKind::inverted_piece:
  case ViolationKind::several_pieces:
  case ViolationKind::nested_piece:
    add_face(a);
    break;
  }
  std::ranges::sort(found.vertices);
  return found.empty() ? std::nullopt : std::optional(found);
}

} // namespace cagewright::app
