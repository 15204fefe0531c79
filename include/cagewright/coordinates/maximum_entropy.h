/// \file
/// Maximum entropy coordinates: positive in every cage.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct MaximumEntropyOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error; ///< or `rest`
};

/// Hormann, Sukumar, "Maximum Entropy Coordinates for Arbitrary Polytopes", SGP 2008, with a prior
/// that does not depend on the unit: docs/coordinates.md.
///
/// \param cage  C vertices; closed, either way out
/// \returns coordinates with a column for each vertex. Inside they are positive, sum to 1 and
///          reproduce the point; nearer than 1e-9 of the diagonal to the cage they are the
///          barycentric coordinates there. Outside there are none.
///
/// Errors: invalid_cage.
/// Cost: O(T) and some steps of O(C) a point.
Result<std::shared_ptr<const Coordinates>>
maximum_entropy_coordinates(const PolygonMesh& cage, const MaximumEntropyOptions& options = {});

/// Among the others, with the options `quads` and `outside`.
extern const CoordinateKind maximum_entropy_kind;

} // namespace cagewright
