/// \file
/// The vertices that a selection moves.
#pragma once

#include "app/edit/selection.h"
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/validate/validate_cage.h>

#include <optional>
#include <vector>

namespace cagewright::app {

/// The selected vertices, and those of the selected edges and faces: ascending, each once.
std::vector<Index> selected_vertices(const Selection& selection, const PolygonMesh& cage);

/// What of the cage is wrong there, as a selection; nothing where it is not of the cage.
std::optional<Selection> selection_at(const Violation& violation, const PolygonMesh& cage);

} // namespace cagewright::app
