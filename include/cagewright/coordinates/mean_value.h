/// \file
/// Mean value coordinates for closed cages of triangles and quads.
#pragma once

#include <cagewright/coordinates/weights.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstdint>
#include <memory>
#include <span>

namespace cagewright {

/// What the surface of the cage is inside a quad.
enum class QuadTreatment {
  /// Four triangles round the mean of the corners, whose weight the corners share: agrees with the
  /// bilinear patch on the boundary and in the middle, and does not depend on how the quad is
  /// written down, so that mirrored cages give mirrored weights. Twice the cost of `diagonal`.
  center,
  /// The two triangles of triangulate(): what a renderer shows.
  diagonal,
};

struct MeanValueOptions {
  QuadTreatment quads = QuadTreatment::center;
  /// Accept a cage with open edges. Its weights still sum to one, but do not reproduce the points.
  bool allow_open = false;
};

/// What became of up to 16 points; bit i speaks of point i.
struct TileReport {
  std::uint16_t on_surface = 0; ///< within 4e-15 of the cage's diagonal: took the surface's weights
  std::uint16_t undefined = 0;  ///< no weights exist, all are 0 (not finite, or a broken cage)
};

/// A cage prepared for computing weights, sixteen points at a time. Immutable: any number of
/// threads may use one.
class MeanValueSolver {
public:
  /// Errors: invalid_cage (no faces, an index out of range, positions not finite or all equal,
  /// open edges unless allowed).
  static Result<MeanValueSolver> create(TriangleView cage, const MeanValueOptions& options = {});
  static Result<MeanValueSolver> create(const PolygonMesh& cage,
                                        const MeanValueOptions& options = {});

  [[nodiscard]] std::size_t cage_vertices() const;

  /// The weights of up to 16 points: weights[c * stride + i] of point i for cage vertex c. Computed
  /// in double, and rounded when stored to float. Of each 16 numbers those behind the last point
  /// become 0.
  /// \param weights  at least (C - 1) stride + 16 numbers
  /// \param stride   at least 16
  TileReport solve(std::span<const Vec3> points, std::span<double> weights,
                   std::size_t stride = 16) const;
  TileReport solve(std::span<const Vec3> points, std::span<float> weights,
                   std::size_t stride = 16) const;

  /// The same computed in float, several times as fast: for previews. A point reproduced with
  /// these weights errs by less than 1e-5 of the cage's diagonal.
  TileReport preview(std::span<const Vec3> points, std::span<float> weights,
                     std::size_t stride = 16) const;

  struct Tables; ///< the prepared cage; defined with the implementation

private:
  explicit MeanValueSolver(std::shared_ptr<const Tables> tables) : tables_(std::move(tables)) {}

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

template <class T> struct SolvedWeights {
  WeightTiles<T> weights;
  std::size_t on_surface = 0; ///< points that lie on the cage
  std::size_t undefined = 0;  ///< points without weights: their rows are zero
};

/// The weights of all points from a prepared cage; T is double or float.
/// Errors: cancelled.
template <class T>
Result<SolvedWeights<T>> solve_all(const MeanValueSolver& solver, std::span<const Vec3> points,
                                   const Progress& progress = {});

} // namespace cagewright
