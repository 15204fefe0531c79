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

} // namespace cagewright::app
