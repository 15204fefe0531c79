/// \file
/// Mean value coordinates of cages whose quads are bilinear patches.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct QuadMeanValueOptions {
  double accuracy = 0; ///< of weights; 0: 1e-6. Sums and reproduction are right to rounding anyway
};

/// Thiery, Memari, Boubekeur, "Mean Value Coordinates for Quad Cages in 3D", SIGGRAPH Asia 2018, of
/// which this is the limit: docs/coordinates.md.
///
/// \param cage  C vertices; closed, either way out; larger faces are cut into triangles
/// \returns coordinates with a column for each vertex. They sum to 1 and reproduce the point,
/// inside
///          and outside. On the cage, nearer than 1e-9 of the diagonal to a patch, they are its
///          bilinear weights.
///
/// In a cage without quads they are mean value coordinates.
/// Errors: invalid_cage.
/// Cost: some 40 nodes for each quad and point, more close by.
Result<std::shared_ptr<const Coordinates>>
quad_mean_value_coordinates(const PolygonMesh& cage, const QuadMeanValueOptions& options = {});

/// Among the others, with the option `accuracy`.
extern const CoordinateKind quad_mean_value_kind;

} // namespace cagewright
