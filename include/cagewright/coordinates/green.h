/// \file
/// Green coordinates: the model follows the cage's vertices and the normals of its faces.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct GreenOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error;
};

/// Lipman, Levin, Cohen-Or, "Green Coordinates", SIGGRAPH 2008, in a closed form that holds
/// everywhere: docs/coordinates.md.
///
/// \param cage  C vertices, T triangles once quads are cut; closed, either way out
/// \returns coordinates with a column for each vertex and one for each triangle with area (in units
///          of the cage's diagonal). Inside, those of vertices sum to 1, and together they
///          reproduce the point. A similarity of the cage does the same to the model. They do not
///          interpolate: on the cage, and to within 1e-13 of its diagonal, they are the limit from
///          inside.
///
/// Errors: invalid_cage (as check_surface() says, or open).
/// Cost: O(T) a point.
Result<std::shared_ptr<const Coordinates>> green_coordinates(const PolygonMesh& cage,
                                                             const GreenOptions& options = {});

/// Green coordinates among the others, with the options `quads` and `outside`.
extern const CoordinateKind green_kind;

} // namespace cagewright
