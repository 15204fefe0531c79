/// \file
/// What all kinds of coordinates have in common: a cage prepared for computing weights.
#pragma once

#include <cagewright/coordinates/columns.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <cstddef>
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

/// What becomes of points outside the cage, where a kind is not defined there by itself.
enum class OutsideTreatment {
  error,        ///< they are refused
  rest,         ///< they have no weights, and stay where they are
  continuation, ///< the formulas go on smoothly through the nearest face; wild farther away
};

/// What became of up to 16 points; bit i speaks of point i.
struct TileReport {
  std::uint16_t on_surface = 0; ///< on the cage: took the weights that hold there
  std::uint16_t undefined = 0;  ///< no weights exist, all are 0 (not finite, or a broken cage)
  std::uint16_t outside = 0;    ///< outside the cage, of a kind that is defined inside alone
};

/// How many points there were of which a TileReport speaks.
struct PointCounts {
  std::size_t on_surface = 0;
  std::size_t undefined = 0;
  std::size_t outside = 0;

  void add(const TileReport& report);
  void add(const PointCounts& other);
};

/// A cage prepared for computing the weights of points, of whatever kind. Immutable: any number of
/// threads may use one.
class Coordinates {
public:
  virtual ~Coordinates() = default;

  /// K, the number of weights of a point.
  [[nodiscard]] std::size_t columns() const { return rule_->columns(); }
  [[nodiscard]] const std::shared_ptr<const ColumnRule>& rule() const { return rule_; }
  /// What happens to points outside the cage; `error` is for who meets the points, see accept().
  [[nodiscard]] OutsideTreatment outside() const { return outside_; }

  /// How far weights inside the cage err at most, as measured at samples of the cage, of kinds that
  /// come near what they are named after by a computation that ends somewhere; 0 for the others.
  [[nodiscard]] virtual double error_bound() const { return 0; }

  /// Of these kinds: how far weights a hundredth of the cage's diagonal inside it, or farther, err
  /// at most, as a coarser computation lets one guess. Near the edges of the cage they err more, up
  /// to the bound, if there is one.
  [[nodiscard]] virtual double error_estimate() const { return error_bound(); }

  /// The weights of up to 16 points: weights[k * stride + i] of point i for column k. Computed in
  /// double, and rounded when stored to float. Of each 16 numbers those behind the last point
  /// become 0, and so do those of points that are undefined, or outside and without weights there.
  /// \param weights  at least (K - 1) stride + 16 numbers
  /// \param stride   at least 16
  TileReport solve(std::span<const Vec3> points, std::span<double> weights,
                   std::size_t stride = 16) const {
    return solve_tile(points, weights, stride);
  }
  TileReport solve(std::span<const Vec3> points, std::span<float> weights,
                   std::size_t stride = 16) const {
    return solve_tile(points, weights, stride);
  }

protected:
  explicit Coordinates(std::shared_ptr<const ColumnRule> rule,
                       OutsideTreatment outside = OutsideTreatment::rest)
      : rule_(std::move(rule)), outside_(outside) {}
  Coordinates(const Coordinates&) = default;
  Coordinates& operator=(const Coordinates&) = default;

private:
  virtual TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                                std::size_t stride) const = 0;
  /// As it stands it rounds those in double.
  virtual TileReport solve_tile(std::span<const Vec3> points, std::span<float> weights,
                                std::size_t stride) const;

  std::shared_ptr<const ColumnRule> rule_;
  OutsideTreatment outside_;
};

/// The weights of any number of points, on the calling thread: weights[k * stride + i] of point i
/// for column k. T is double or float.
/// \param stride   at least as many as there are points, rounded up to a multiple of 16
template <class T>
PointCounts solve_block(const Coordinates& coordinates, std::span<const Vec3> points,
                        std::span<T> weights, std::size_t stride);

/// Whether these points may be bound: an error (invalid_cage) if there are points outside and the
/// kind refuses them.
Status accept(const Coordinates& coordinates, const PointCounts& counts);

template <class T> struct SolvedWeights {
  WeightTiles<T> weights;
  PointCounts counts;
};

/// The weights of all points; T is double or float. On all cores of the calling arena; the result
/// does not depend on their number.
/// Errors: cancelled, invalid_cage (points outside that the kind refuses).
template <class T>
Result<SolvedWeights<T>> solve_all(const Coordinates& coordinates, std::span<const Vec3> points,
                                   const Progress& progress = {});

} // namespace cagewright
