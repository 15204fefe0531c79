/// \file
/// Biharmonic coordinates: the model follows the cage closely, and the directions of its faces.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct BiharmonicOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error; ///< or `rest`
  double closeness = 1; ///< gamma > 0: the larger, the closer to the cage, and the less smooth
};

/// Thiery, Michel, Chen, "Biharmonic Coordinates and their Derivatives for Triangular 3D Cages",
/// SIGGRAPH 2024, with positions and normals given: docs/coordinates.md.
///
/// \param cage  C vertices, T triangles once quads are cut; closed, either way out
/// \returns coordinates with the columns of green_coordinates(). They sum to 1, reproduce the
/// point, and
///          a similarity of the cage does the same to the model. Outside there are none.
///
/// Errors: invalid_cage, invalid_option, cancelled, too_large.
/// Cost: O(T (C + T)^2) to prepare, O((C + T)^2) a point.
Result<std::shared_ptr<const Coordinates>>
biharmonic_coordinates(const PolygonMesh& cage, const BiharmonicOptions& options = {},
                       const Progress& progress = {});

/// Among the others, with the options `quads`, `outside` and `closeness`.
extern const CoordinateKind biharmonic_kind;

} // namespace cagewright
