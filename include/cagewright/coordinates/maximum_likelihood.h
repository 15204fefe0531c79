/// \file
/// Maximum likelihood coordinates: positive in every cage, smooth.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>

namespace cagewright {

struct MaximumLikelihoodOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error; ///< or `rest`
};

/// Chang, Deng, Hormann, "Maximum Likelihood Coordinates", SGP 2023: docs/coordinates.md.
///
/// \param cage  C vertices; closed, either way out
/// \returns coordinates with a column for each vertex. Inside they sum to 1, reproduce the point
/// and
///          are positive, but at points where no positive ones of the kind exist; on the cage they
///          are the barycentric coordinates there. Outside there are none.
///
/// Errors: invalid_cage.
/// Cost: O(T) and some steps of O(C) a point.
Result<std::shared_ptr<const Coordinates>>
maximum_likelihood_coordinates(const PolygonMesh& cage,
                               const MaximumLikelihoodOptions& options = {});

/// Among the others, with the options `quads` and `outside`.
extern const CoordinateKind maximum_likelihood_kind;

} // namespace cagewright
