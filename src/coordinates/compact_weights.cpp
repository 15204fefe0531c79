#include <cagewright/coordinates/compact_weights.h>

#include "core/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>

namespace cagewright {
namespace {

constexpr std::size_t tile_points = FloatWeights::tile_points;
constexpr std::size_t block_points = CompactWeights::block_tiles * tile_points;
constexpr std::size_t at_once = 128; // points between two looks at the stop token
constexpr double largest = 32767;

std::size_t block_count(const CompactWeights& weights) {
  return (weights.tile_count() + CompactWeights::block_tiles - 1) / CompactWeights::block_tiles;
}

/// Rounds the tiles of a block, `from`, one after the other.
void round_block(std::size_t block, std::span<const float> from, CompactWeights& compact) {
  const std::size_t count = compact.columns();
  const std::span<double> steps = std::span(compact.steps).subspan(block * count, count);
  std::fill(steps.begin(), steps.end(), 0.0);
  const std::size_t tile_size = tile_points * count;
  for (std::size_t i = 0; i < from.size(); ++i) {
    double& step = steps[i % tile_size / tile_points];
    step = std::max(step, std::abs(static_cast<double>(from[i])) / largest);
  }
  for (std::size_t first = 0; first < from.size(); first += tile_size) {
    const std::size_t tile = block * CompactWeights::block_tiles + first / tile_size;
    const std::span<std::int16_t> to = compact.tiles.tile(tile);
    for (std::size_t i = 0; i < tile_size; ++i) {
      const double step = steps[i / tile_points];
      to[i] = static_cast<std::int16_t>(step > 0 ? std::lround(from[first + i] / step) : 0);
    }
  }
}

} // namespace

CompactWeights::CompactWeights(std::size_t points, std::size_t columns)
    : tiles(points, columns), steps(block_count(*this) * columns) {}

CompactWeights make_compact(const FloatWeights& weights) {
  CompactWeights compact(weights.points(), weights.columns());
  const std::size_t tile_size = tile_points * weights.columns();
  parallel_for(0, block_count(compact), 1, [&](std::size_t block) {
    const std::size_t first = block * CompactWeights::block_tiles;
    const std::size_t tiles = std::min(CompactWeights::block_tiles, weights.tile_count() - first);
    round_block(block, {weights.tile(first).data(), tiles * tile_size}, compact);
  });
  return compact;
}

Result<SolvedCompactWeights> solve_compact(const Coordinates& coordinates,
                                           std::span<const Vec3> points, const Progress& progress) {
  SolvedCompactWeights solved{{points.size(), coordinates.columns()}, {}};
  const std::size_t tile_size = tile_points * coordinates.columns();
  const std::size_t blocks = block_count(solved.weights);
  std::mutex reporting;
  std::size_t finished = 0;
  parallel_for(0, blocks, 1, [&](std::size_t block) {
    const std::size_t first = block * block_points;
    const std::size_t count = std::min(block_points, points.size() - first);
    FloatWeights exact(count, coordinates.columns());
    PointCounts counts;
    for (std::size_t i = 0; i < count; i += at_once) {
      if (progress.cancelled()) {
        return;
      }
      counts.add(solve_block(coordinates, points.subspan(first + i, std::min(at_once, count - i)),
                             exact.from(i), tile_points));
    }
    exact.fill_up();
    round_block(block, {exact.tile(0).data(), exact.tile_count() * tile_size}, solved.weights);
    const std::scoped_lock lock(reporting);
    solved.counts.add(counts);
    progress(static_cast<double>(++finished) / static_cast<double>(blocks), "bind");
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  if (Status status = accept(coordinates, solved.counts); !status) {
    return status.error();
  }
  return solved;
}

double position_error_bound(const CompactWeights& weights, std::span<const Vec3> displacements) {
  assert(displacements.size() == weights.columns());
  double greatest = 0;
  for (std::size_t t = 0; t < weights.tile_count(); t += CompactWeights::block_tiles) {
    const std::span<const double> steps = weights.steps_of_tile(t);
    double bound = 0;
    for (std::size_t c = 0; c < displacements.size(); ++c) {
      bound += 0.5 * steps[c] * displacements[c].norm();
    }
    greatest = std::max(greatest, bound);
  }
  return greatest;
}

} // namespace cagewright
