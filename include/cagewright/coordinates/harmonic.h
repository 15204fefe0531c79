/// \file
/// Harmonic coordinates by boundary elements, with a certificate of how near they come.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <cstddef>
#include <memory>

namespace cagewright {

struct HarmonicOptions {
  QuadTreatment quads = QuadTreatment::center;
  OutsideTreatment outside = OutsideTreatment::error; ///< or `rest`
  double accuracy = 0; ///< of weights inside (error_estimate()); 0: 2e-3
  /// Where they do not suffice the error stays larger; 0: 4500, or 8000 if an accuracy is given.
  std::size_t unknowns = 0;
};

/// Joshi, Meyer, DeRose, Green, Sanocki, "Harmonic Coordinates for Character Articulation",
/// SIGGRAPH 2007, without a grid: docs/coordinates.md.
///
/// Harmonic functions are made of their values and normal derivatives on the cage. The former are
/// known, the latter are solved for. The error is harmonic itself, and so nowhere inside larger
/// than on the cage, where it is measured: error_bound(). There it is largest at sharp edges and
/// corners; inside it is far smaller: error_estimate().
///
/// \param cage  C vertices; closed, either way out
/// \returns coordinates with a column for each vertex. Inside they are not negative, sum to 1,
///          reproduce the point and fall off quickly. Outside there are none.
///
/// Errors: invalid_cage, cancelled, too_large.
/// Cost: ten seconds to prepare a cage of 200 triangles; O(T C) a point.
Result<std::shared_ptr<const Coordinates>> harmonic_coordinates(const PolygonMesh& cage,
                                                                const HarmonicOptions& options = {},
                                                                const Progress& progress = {});

/// Among the others, with the options `quads`, `outside` and `accuracy`.
extern const CoordinateKind harmonic_kind;

} // namespace cagewright
