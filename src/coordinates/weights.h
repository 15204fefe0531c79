/// \file
/// How much each point follows each cage vertex: the result of every kind of coordinates.
#pragma once

#include "coordinates/aligned_buffer.h"

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// P points by C cage vertices, in tiles of 16 points.
///
/// A tile holds, for one cage vertex after the other, the weights of its 16 points:
/// tile(p / 16)[c * 16 + p % 16] is the weight of point p for cage vertex c. Applying the weights
/// reads memory once and in order, sixteen points at a time in vector registers; moving k cage
/// vertices reads k cache lines of a tile and leaves the others alone. The last tile is filled up
/// with rows of zeros.
template <class T> class WeightTiles {
public:
  static constexpr std::size_t tile_points = 16;

  WeightTiles() = default;

  /// The weights are not set: the maker writes every tile.
  WeightTiles(std::size_t points, std::size_t cage_vertices)
      : points_(points), cage_vertices_(cage_vertices),
        data_(tile_count() * tile_points * cage_vertices) {}

  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] std::size_t cage_vertices() const { return cage_vertices_; }
  [[nodiscard]] std::size_t tile_count() const { return (points_ + tile_points - 1) / tile_points; }

  /// 16 C weights.
  [[nodiscard]] std::span<T> tile(std::size_t t) {
    return data_.span().subspan(t * tile_points * cage_vertices_, tile_points * cage_vertices_);
  }
  [[nodiscard]] std::span<const T> tile(std::size_t t) const {
    return data_.span().subspan(t * tile_points * cage_vertices_, tile_points * cage_vertices_);
  }

  [[nodiscard]] T at(std::size_t point, std::size_t cage_vertex) const {
    assert(point < points_ && cage_vertex < cage_vertices_);
    return tile(point / tile_points)[cage_vertex * tile_points + point % tile_points];
  }

  /// The C weights of a point, gathered: for looking at, not for speed.
  [[nodiscard]] std::vector<T> row(std::size_t point) const {
    std::vector<T> weights(cage_vertices_);
    for (std::size_t c = 0; c < cage_vertices_; ++c) {
      weights[c] = at(point, c);
    }
    return weights;
  }

  [[nodiscard]] std::size_t bytes() const { return data_.size() * sizeof(T); }

private:
  std::size_t points_ = 0;
  std::size_t cage_vertices_ = 0;
  AlignedBuffer<T> data_;
};

using Weights = WeightTiles<double>;
using FloatWeights = WeightTiles<float>;

} // namespace cagewright
