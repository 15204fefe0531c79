/// \file
/// Loops and open chains of edges.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <span>
#include <vector>

namespace cagewright {

/// Vertices along edges, each once.
struct EdgeChain {
  std::vector<Index> vertices;
  bool closed = false; ///< an edge leads from the last vertex to the first
  bool simple = true;  ///< no other edge given begins or ends at one of its vertices
};

/// Directed edges strung together: where several edges leave a vertex it is left open which of them
/// a chain goes on with, and the chain is not simple. Chains that begin where no edge leads to come
/// first, and then each begins at its least vertex.
std::vector<EdgeChain> chains_of(std::span<const std::array<Index, 2>> edges);

/// The edges between faces of different parts, each once, with the greater part to the left.
std::vector<std::array<Index, 2>> edges_between_parts(const PolygonMesh& mesh,
                                                      std::span<const Index> parts);

} // namespace cagewright
