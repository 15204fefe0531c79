/// \file
/// The lines of a model that is drawn as a wireframe.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>

#include <array>
#include <vector>

namespace cagewright::app {

/// The sides of all polygons, each once, its lower vertex first; no diagonals. O(V + C log d) for C
/// corners and d of them at a vertex: a million triangles take no longer than reading them does.
std::vector<std::array<Index, 2>> wire_edges(const PolygonMesh& mesh);

} // namespace cagewright::app
