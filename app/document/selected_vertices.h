/// \file
/// The vertices that a selection moves.
#pragma once

#include "app/edit/selection.h"
#include <cagewright/mesh/polygon_mesh.h>

#include <vector>

namespace cagewright::app {

/// The selected vertices, and those of the selected edges and faces: ascending, each once.
std::vector<Index> selected_vertices(const Selection& selection, const PolygonMesh& cage);

} // namespace cagewright::app
