/// \file
/// What is selected in a cage.
#pragma once

#include "mesh/topology.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright::app {

enum class SelectionMode { vertex, edge, face };

/// The selected elements of a cage. Only the list of the mode holds any; each is ascending and
/// without repetitions, edges with their lower vertex first.
struct Selection {
  SelectionMode mode = SelectionMode::vertex;
  std::vector<Index> vertices;
  std::vector<EdgeVertices> edges;
  std::vector<Index> faces;

  [[nodiscard]] bool empty() const { return vertices.empty() && edges.empty() && faces.empty(); }
  [[nodiscard]] std::size_t size() const { return vertices.size() + edges.size() + faces.size(); }
  friend bool operator==(const Selection&, const Selection&) = default;
};

} // namespace cagewright::app
