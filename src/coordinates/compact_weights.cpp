#include "coordinates/compact_weights.h"

#include "core/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cagewright {
namespace {

constexpr std::size_t tile_points = FloatWeights::tile_points;
constexpr double largest = 32767;

std::vector<double> steps_of(const FloatWeights& weights) {
  const std::vector<double> none(weights.cage_vertices(), 0.0);
  std::vector<double> steps = parallel_reduce_ordered(
      0, weights.tile_count(), 256, none,
      [&](std::size_t first, std::size_t last) {
        std::vector<double> sizes = none;
        for (std::size_t t = first; t < last; ++t) {
          const std::span<const float> tile = weights.tile(t);
          for (std::size_t i = 0; i < tile.size(); ++i) {
            double& size = sizes[i / tile_points];
            size = std::max(size, std::abs(static_cast<double>(tile[i])));
          }
        }
        return sizes;
      },
      [](std::vector<double>& a, const std::vector<double>& b) {
        for (std::size_t c = 0; c < a.size(); ++c) {
          a[c] = std::max(a[c], b[c]);
        }
      });
  for (double& step : steps) {
    step /= largest;
  }
  return steps;
}

} // namespace

CompactWeights make_compact(const FloatWeights& weights) {
  CompactWeights compact{{weights.points(), weights.cage_vertices()}, steps_of(weights)};
  parallel_for(0, weights.tile_count(), 16, [&](std::size_t t) {
    const std::span<const float> from = weights.tile(t);
    const std::span<std::int16_t> to = compact.tiles.tile(t);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double step = compact.steps[i / tile_points];
      to[i] = static_cast<std::int16_t>(step > 0 ? std::lround(from[i] / step) : 0);
    }
  });
  return compact;
}

double position_error_bound(const CompactWeights& weights, std::span<const Vec3> displacements) {
  assert(displacements.size() == weights.cage_vertices());
  double bound = 0;
  for (std::size_t c = 0; c < displacements.size(); ++c) {
    bound += 0.5 * weights.steps[c] * displacements[c].norm();
  }
  return bound;
}

} // namespace cagewright
