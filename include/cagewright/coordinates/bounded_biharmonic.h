/// \file
/// Bounded biharmonic weights, on tetrahedra of their own.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <cstddef>
#include <memory>

namespace cagewright {

struct BoundedBiharmonicOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error; ///< or `rest`
  double accuracy =
      0; ///< of weights (error_estimate()), as far as 20,000 points go; 0: as it comes
  std::size_t points = 0; ///< of the tetrahedra, about; 0: 7000
};

/// Jacobson, Baran, Popovic, Sorkine, "Bounded Biharmonic Weights for Real-Time Deformation",
/// SIGGRAPH 2011: docs/coordinates.md.
///
/// Of all functions between 0 and 1 that are the hat of a vertex on the cage, and flat across it,
/// the one with the least integral of (Laplacian)^2; divided by the sum over the vertices. Made of
/// linear elements on tetrahedra inside the cage, which need nothing but the cage.
///
/// They do not reproduce points: what follows is what differs between the cage and the similarity
/// of its rest that comes nearest, and the model takes part in that as a whole.
///
/// \param cage  C vertices; closed, either way out
/// \returns coordinates with a column for each vertex and three for the point itself. Weights of
///          vertices are in [0, 1] and sum to 1. Outside there are none.
///
/// Errors: invalid_cage, cancelled.
/// Cost: some seconds to prepare a cage; a point then costs little more than the place it has.
Result<std::shared_ptr<const Coordinates>>
bounded_biharmonic_coordinates(const PolygonMesh& cage,
                               const BoundedBiharmonicOptions& options = {},
                               const Progress& progress = {});

/// Among the others, with the options `quads`, `outside` and `accuracy`.
extern const CoordinateKind bounded_biharmonic_kind;

} // namespace cagewright
