/// \file
/// Somigliana coordinates: the model moves as an elastic body of which the cage is the surface.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct SomiglianaOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error;
  double poisson_ratio = 0.3; ///< of the body: 0 to 0.499, nearly incompressible
  double bulge = 0;           ///< how much convex bends swell: 0 not, 1 much; while posing
  double local = 0;           ///< how far rotations and stretches are those of each face: 0 to 1
};

/// Chen, de Goes, Desbrun, "Somigliana Coordinates: an elasticity-derived approach for cage
/// deformation", SIGGRAPH 2023, in a closed form that holds everywhere: docs/coordinates.md.
///
/// \param cage  C vertices, T triangles once quads are cut; closed, either way out
/// \returns coordinates with nine columns for each vertex and middle of a quad (a matrix, row by
/// row),
///          three for each triangle with area (in units of the cage's diagonal), and four for where
///          the point is. A similarity of the cage does the same to the model. They do not
///          interpolate; on the cage they are the limit from inside.
///
/// Errors: invalid_cage, invalid_option.
/// Cost: O(T) a point, and 9 C + 3 T + 4 numbers.
Result<std::shared_ptr<const Coordinates>>
somigliana_coordinates(const PolygonMesh& cage, const SomiglianaOptions& options = {});

/// Among the others, with the options `quads`, `outside`, `poisson-ratio`, `bulge` and `local`.
extern const CoordinateKind somigliana_kind;

} // namespace cagewright
