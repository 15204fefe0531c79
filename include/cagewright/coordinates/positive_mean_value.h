/// \file
/// Positive mean value coordinates: what a point does not see does not move it.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct PositiveMeanValueOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error; ///< or `rest`
};

/// Lipman, Kopf, Cohen-Or, Levin, "GPU-assisted Positive Mean Value Coordinates for Mesh
/// Deformations", SGP 2007, with exact visibility in place of a depth buffer:
/// docs/coordinates.md.
///
/// \param cage  C vertices; closed, either way out, not crossing itself
/// \returns coordinates with a column for each vertex. Inside they are not negative, sum to 1 and
///          reproduce the point; those of vertices of which no face is seen are 0. They are
///          continuous, but not smooth where something comes into view. In convex cages they are
///          mean value coordinates; on the cage the barycentric ones. Outside there are none.
///
/// Errors: invalid_cage.
/// Cost: O(T) a point, and O(T) for each face that hides another.
Result<std::shared_ptr<const Coordinates>>
positive_mean_value_coordinates(const PolygonMesh& cage,
                                const PositiveMeanValueOptions& options = {});

/// Among the others, with the options `quads` and `outside`.
extern const CoordinateKind positive_mean_value_kind;

} // namespace cagewright
