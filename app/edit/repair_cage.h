/// \file
/// Cages from elsewhere that are nearly right, made right.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>

namespace cagewright::app {

/// Vertices on open edges that are nearer to each other than `tolerance`, and those in exactly the
/// same place, made one; faces that lose their area by it and vertices that no face uses go.
/// Colors and groups are not kept.
///
/// Cost: O(C + B^2) for B vertices on open edges.
PolygonMesh welded_cage(const PolygonMesh& cage, double tolerance);

/// Neighboring faces turned to the same side, and closed pieces to the outside. Groups are kept.
PolygonMesh turned_outward(const PolygonMesh& cage);

} // namespace cagewright::app
