/// \file
/// Green coordinates of cages whose quads are bilinear patches.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct QuadGreenOptions {
  double accuracy = 0; ///< of weights; 0: 1e-6. Sums and reproduction are right to rounding anyway
  OutsideTreatment outside = OutsideTreatment::error;
};

/// Thiery, Boubekeur, "Green Coordinates for Triquad Cages in 3D", SIGGRAPH Asia 2022, with a
/// quadrature that keeps the laws: docs/coordinates.md.
///
/// \param cage  C vertices; closed, either way out; larger faces are cut into triangles
/// \returns coordinates with a column for each vertex, one for each triangle and four for each
/// quad:
///          the normals at its corners. They sum to 1, reproduce the point, and a similarity of the
///          cage does the same to the model. On a patch, and nearer than 1e-9 of the diagonal, they
///          are those just inside.
///
/// Errors: invalid_cage.
/// Cost: some 40 nodes for each quad and point, more close by.
Result<std::shared_ptr<const Coordinates>>
quad_green_coordinates(const PolygonMesh& cage, const QuadGreenOptions& options = {});

/// Among the others, with the options `accuracy` and `outside`.
extern const CoordinateKind quad_green_kind;

} // namespace cagewright
