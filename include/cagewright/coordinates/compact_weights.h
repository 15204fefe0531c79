/// \file
/// Weights in half the memory, with a proven bound on what that costs.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// Weights as 16-bit multiples of a step, one for each column in each block of 1024 points:
/// weight(p, c) = tiles.at(p, c) * steps_of_tile(p / 512)[c].
///
/// Meant for displacements (rest position + sum of weight times displacement), where a cage at rest
/// leaves the model exactly where it is. Half-precision floats would take the same memory, and err
/// eight times as much on the weights that matter, the large ones.
struct CompactWeights {
  static constexpr std::size_t block_tiles = 2; ///< tiles that share their steps

  WeightTiles<std::int16_t> tiles;
  std::vector<double> steps; ///< K for each block

  CompactWeights() = default;
  /// The weights are not set.
  CompactWeights(std::size_t points, std::size_t columns);

  [[nodiscard]] std::size_t points() const { return tiles.points(); }
  [[nodiscard]] std::size_t columns() const { return tiles.columns(); }
  [[nodiscard]] std::size_t tile_count() const { return tiles.tile_count(); }
  [[nodiscard]] std::size_t bytes() const { return tiles.bytes(); }
  [[nodiscard]] std::span<const double> steps_of_tile(std::size_t tile) const {
    return std::span(steps).subspan(tile / block_tiles * columns(), columns());
  }
};

/// Rounds the weights: a step is the largest weight of the cage vertex in the block / 32767, so
/// every weight changes by half a step at most.
CompactWeights make_compact(const FloatWeights& weights);

struct SolvedCompactWeights {
  CompactWeights weights;
  PointCounts counts;
};

/// The weights of all points, rounded block by block: they never stand in
/// memory otherwise. Errors: those of solve_all().
Result<SolvedCompactWeights> solve_compact(const Coordinates& coordinates,
                                           std::span<const Vec3> points,
                                           const Progress& progress = {});

/// No point is moved by these displacements (K) farther than this from where the original weights
/// would have moved it: the sum of half a step times the length of the displacement, in the block
/// where that is greatest.
double position_error_bound(const CompactWeights& weights, std::span<const Vec3> displacements);

} // namespace cagewright
