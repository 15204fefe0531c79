/// \file
/// Mean value coordinates for closed cages of triangles and quads.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <memory>
#include <span>

namespace cagewright {

struct MeanValueOptions {
  QuadTreatment quads = QuadTreatment::center;
  /// Accept a cage with open edges. Its weights still sum to one, but do not reproduce the points.
  bool allow_open = false;
};

/// A cage prepared for computing weights, sixteen points at a time. Immutable: any number of
/// threads may use one.
class MeanValueSolver : public Coordinates {
public:
  /// Errors: invalid_cage (no faces, an index out of range, positions not finite or all equal,
  /// open edges unless allowed).
  static Result<MeanValueSolver> create(TriangleView cage, const MeanValueOptions& options = {});
  static Result<MeanValueSolver> create(const PolygonMesh& cage,
                                        const MeanValueOptions& options = {});

  /// What solve() computes in double, computed in float, several times as fast: for previews. A
  /// point reproduced with these weights errs by less than 1e-5 of the cage's diagonal.
  TileReport preview(std::span<const Vec3> points, std::span<float> weights,
                     std::size_t stride = 16) const;

  struct Tables; ///< the prepared cage; defined with the implementation

private:
  MeanValueSolver(std::shared_ptr<const Tables> tables, std::span<const Vec3> cage);
  TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                        std::size_t stride) const override;
  TileReport solve_tile(std::span<const Vec3> points, std::span<float> weights,
                        std::size_t stride) const override;

  std::shared_ptr<const Tables> tables_;
};

/// Binds points to a cage by mean value coordinates.
///
/// Ju, Schaefer and Warren, "Mean Value Coordinates for Closed Triangular Meshes", SIGGRAPH 2005;
/// how it is computed, and why so: docs/coordinates.md.
///
/// \param cage    C vertices and T triangles, closed and consistently oriented, either way out;
///                it may be concave or in several pieces
/// \param points  P positions in the cage's units, anywhere in space
/// \returns P x C weights. Each row sums to 1 and reproduces its point: points[p] is the sum over c
///          of weight(p, c) * cage.positions[c]. On the cage they are its barycentric coordinates.
///          Weights may be negative where the cage is not convex, and outside it.
///
/// Errors: invalid_cage, cancelled. On all cores of the calling arena; the result does not depend
/// on their number.
/// Cost: O(P T) time, P C numbers.
Result<Weights> mean_value_coordinates(TriangleView cage, std::span<const Vec3> points,
                                       const MeanValueOptions& options = {},
                                       const Progress& progress = {});
Result<Weights> mean_value_coordinates(const PolygonMesh& cage, std::span<const Vec3> points,
                                       const MeanValueOptions& options = {},
                                       const Progress& progress = {});

/// Mean value coordinates among the others, with the option `quads`.
extern const CoordinateKind mean_value_kind;

} // namespace cagewright
