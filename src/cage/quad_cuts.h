/// \file
/// A cage of quads as the triangles it may be cut into. Internal to this module.
#pragma once

#include "spatial/bvh.h"
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>

namespace cagewright {

/// All quads cut along their first diagonal, and along their second: every triangle that any choice
/// of diagonals has is in one of the two.
std::array<TriangleMesh, 2> cuts_of(const PolygonMesh& cage);

/// How far a cage is from a model at most, along any diagonals: in the model's units, to within
/// `tolerance`.
double greatest_gap_along_any(const PolygonMesh& cage, const TriangleBvh& model, double tolerance);

} // namespace cagewright
