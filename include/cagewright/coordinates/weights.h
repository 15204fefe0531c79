/// \file
/// How much each point follows each column, such as each vertex of the cage: the result of every
/// kind of coordinates.
#pragma once

#include <cagewright/coordinates/aligned_buffer.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// P points by K columns, in tiles of 512 points.
///
/// A tile holds, for one column after the other, the weights of its 512 points:
/// tile(p / 512)[k * 512 + p % 512] is the weight of point p for column k. Applying the
/// weights reads memory once and in order. Moving some columns reads as many runs of 2 kB (of
/// floats) and leaves the others alone: long enough that the processor fetches little besides,
/// short enough that the sums under way for a tile stay in its nearest cache. The last tile is
/// filled up with rows of zeros.
template <class T> class WeightTiles {
public:
  static constexpr std::size_t tile_points = 512;

  WeightTiles() = default;

  /// The weights are not set: the maker writes every tile.
  WeightTiles(std::size_t points, std::size_t columns)
      : points_(points), columns_(columns), data_(tile_count() * tile_points * columns) {}

  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t tile_count() const { return (points_ + tile_points - 1) / tile_points; }

  /// 512 K weights.
  [[nodiscard]] std::span<T> tile(std::size_t t) {
    return data_.span().subspan(t * tile_points * columns_, tile_points * columns_);
  }
  [[nodiscard]] std::span<const T> tile(std::size_t t) const {
    return data_.span().subspan(t * tile_points * columns_, tile_points * columns_);
  }

  [[nodiscard]] T at(std::size_t point, std::size_t column) const {
    assert(point < points_ && column < columns_);
    return tile(point / tile_points)[column * tile_points + point % tile_points];
  }

  /// Where the weights of points from `point` on begin: those for the next column are
  /// tile_points further.
  [[nodiscard]] std::span<T> from(std::size_t point) {
    return tile(point / tile_points).subspan(point % tile_points);
  }

  /// Sets the rows behind the last point to zero.
  void fill_up() {
    for (std::size_t used = points_ % tile_points, c = 0; used > 0 && c < columns_; ++c) {
      const std::span<T> rest = tile(tile_count() - 1).subspan(c * tile_points + used);
      std::fill_n(rest.begin(), tile_points - used, T(0));
    }
  }

  /// The K weights of a point, gathered: for looking at, not for speed.
  [[nodiscard]] std::vector<T> row(std::size_t point) const {
    std::vector<T> weights(columns_);
    for (std::size_t c = 0; c < columns_; ++c) {
      weights[c] = at(point, c);
    }
    return weights;
  }

  [[nodiscard]] std::size_t bytes() const { return data_.size() * sizeof(T); }

private:
  std::size_t points_ = 0;
  std::size_t columns_ = 0;
  AlignedBuffer<T> data_;
};

using Weights = WeightTiles<double>;
using FloatWeights = WeightTiles<float>;

} // namespace cagewright
