#include <cagewright/coordinates/compact_weights.h>

#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <mutex>

namespace cagewright {
namespace {

constexpr std::size_t tile_points = FloatWeights::tile_points;
constexpr std::size_t block_points = CompactWeights::block_tiles * tile_points;
constexpr double largest = 32767;

std::size_t block_count(const CompactWeights& weights) {
  return (weights.tile_count() + CompactWeights::block_tiles - 1) / CompactWeights::block_tiles;
}

/// Rounds the tiles of a block, `from`, one after the other.
void round_block(std::size_t block, std::span<const float> from, CompactWeights& compact) {
  const std::size_t count = compact.cage_vertices();
  const std::span<double> steps = std::span(compact.steps).subspan(block * count, count);
  std::ranges::fill(steps, 0.0);
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

CompactWeights::CompactWeights(std::size_t points, std::size_t cage_vertices)
    : tiles(points, cage_vertices), steps(block_count(*this) * cage_vertices) {}

CompactWeights make_compact(const FloatWeights& weights) {
  CompactWeights compact(weights.points(), weights.cage_vertices());
  const std::size_t tile_size = tile_points * weights.cage_vertices();
  parallel_for(0, block_count(compact), 1, [&](std::size_t block) {
    const std::size_t first = block * CompactWeights::block_tiles;
    const std::size_t tiles = std::min(CompactWeights::block_tiles, weights.tile_count() - first);
    round_block(block, {weights.tile(first).data(), tiles * tile_size}, compact);
  });
  return compact;
}

Result<SolvedCompactWeights> solve_compact(const MeanValueSolver& solver,
                                           std::span<const Vec3> points, const Progress& progress) {
  SolvedCompactWeights solved{{points.size(), solver.cage_vertices()}};
  const std::size_t tile_size = tile_points * solver.cage_vertices();
  const std::size_t blocks = block_count(solved.weights);
  std::mutex reporting;
  std::size_t finished = 0;
  parallel_for(0, blocks, 1, [&](std::size_t block) {
    const std::size_t first = block * block_points;
    const std::size_t count = std::min(block_points, points.size() - first);
    FloatWeights exact(count, solver.cage_vertices());
    int on_surface = 0;
    int undefined = 0;
    for (std::size_t i = 0; i < count; i += 16) {
      if (progress.cancelled()) {
        return;
      }
      const TileReport report =
          solver.solve(points.subspan(first + i, std::min<std::size_t>(16, count - i)),
                       exact.from(i), tile_points);
      on_surface += std::popcount(report.on_surface);
      undefined += std::popcount(report.undefined);
    }
    exact.fill_up();
    round_block(block, {exact.tile(0).data(), exact.tile_count() * tile_size}, solved.weights);
    const std::scoped_lock lock(reporting);
    solved.on_surface += static_cast<std::size_t>(on_surface);
    solved.undefined += static_cast<std::size_t>(undefined);
    progress(static_cast<double>(++finished) / static_cast<double>(blocks), "bind");
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  return solved;
}

double position_error_bound(const CompactWeights& weights, std::span<const Vec3> displacements) {
  assert(displacements.size() == weights.cage_vertices());
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
