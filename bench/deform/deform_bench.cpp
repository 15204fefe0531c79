// Moving a bound model: how near to the memory's own speed, and what k of M cage vertices cost.

#include "core/parallel.h"
#include "core/random.h"
#include "deform/apply.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/compact_weights.h>
#include <cagewright/deform/deformer.h>

#include <benchmark/benchmark.h>
#include <hwy/cache_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <numeric>
#include <span>
#include <vector>

namespace cagewright {
namespace {

constexpr std::size_t points = 173000; // the full Armadillo scan
constexpr std::size_t cage_vertices = 199;

/// Any numbers: applying does not look at them.
const FloatWeights& weights() {
  static const FloatWeights made = [] {
    FloatWeights w(points, cage_vertices);
    parallel_for(0, w.tile_count(), 64, [&](std::size_t t) {
      Random random(t);
      for (float& x : w.tile(t)) {
        x = static_cast<float>(random.uniform() / cage_vertices);
      }
    });
    return w;
  }();
  return made;
}

const CompactWeights& compact_weights() {
  static const CompactWeights made = make_compact(weights());
  return made;
}

void count_bytes(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
}

/// The yardstick: the same bytes, only read and summed; four runs of 2 kB side by side, the next
/// ones fetched ahead, which is the quickest way of reading found here.
void read_all(const FloatWeights& w, std::span<double> sums) {
  constexpr std::size_t run = 512;
  parallel_for(0, w.tile_count(), 2, [&](std::size_t t) {
    const std::span<const float> tile = w.tile(t);
    std::array<float, 16> sum{};
    std::size_t begin = 0;
    for (; begin + 4 * run <= tile.size(); begin += 4 * run) {
      for (const float* line = &tile[begin]; line != &tile[begin] + run; line += 16) {
        for (std::size_t side = 0; side < 4 * run; side += run) {
          hwy::Prefetch(line + side + 4 * run);
          for (std::size_t k = 0; k < 16; ++k) {
            sum[k] += line[side + k];
          }
        }
      }
    }
    sums[t] = std::accumulate(tile.begin() + static_cast<std::ptrdiff_t>(begin), tile.end(),
                              std::accumulate(sum.begin(), sum.end(), 0.0));
  });
}

void read_memory(benchmark::State& state) {
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  std::vector<double> sums(weights().tile_count());
  for (auto _ : state) {
    arena.execute([&] { read_all(weights(), sums); });
    benchmark::DoNotOptimize(sums.data());
  }
  count_bytes(state, weights().bytes());
}

/// The bytes counted are those that must pass: the weights of the moved vertices, the rest and the
/// positions once read, the positions once written.
template <class SomeWeights>
void move(benchmark::State& state, const SomeWeights& tiles, std::size_t k, int threads) {
  std::vector<Vec3> rest(points, Vec3(1, 2, 3));
  std::vector<Vec3> moved = rest;
  std::vector<Index> vertices(k);
  for (std::size_t i = 0; i < k; ++i) {
    vertices[i] = static_cast<Index>(i * cage_vertices / k);
  }
  const std::vector<Vec3> displacements(k, Vec3(0.1, 0.2, 0.3));
  tbb::task_arena arena(threads);
  for (auto _ : state) {
    arena.execute([&] { move_points(tiles, vertices, displacements, rest, moved); });
    benchmark::DoNotOptimize(moved.data());
  }
  count_bytes(state, tiles.bytes() * k / cage_vertices + 3 * points * sizeof(Vec3));
}

void move_all(benchmark::State& state) {
  move(state, weights(), cage_vertices, static_cast<int>(state.range(0)));
}
void move_all_compact(benchmark::State& state) {
  move(state, compact_weights(), cage_vertices, static_cast<int>(state.range(0)));
}

/// Processor time of this thread, which other programs lengthen less than time on the wall.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class F> void keep_best(double& best, const F& run) {
  const double begin = thread_seconds();
  run();
  best = std::min(best, thread_seconds() - begin);
}

/// Moving k of the cage's M vertices, beside moving all and plain reading, in turns and in one
/// thread; each counts with its best time. Counters:
///     ms        of moving k
///     of_share  that time over k/M of the time for all: 1 would be ideal
///     speed     bytes that must pass per second, over those of plain reading
template <class SomeWeights> void share_of(benchmark::State& state, const SomeWeights& tiles) {
  const auto k = static_cast<std::size_t>(state.range(0));
  const std::vector<Vec3> rest(points, Vec3(1, 2, 3));
  std::vector<Vec3> moved = rest;
  std::vector<Index> some(k);
  std::vector<Index> all(cage_vertices);
  std::iota(all.begin(), all.end(), Index(0));
  for (std::size_t i = 0; i < k; ++i) {
    some[i] = static_cast<Index>(state.range(1) != 0 ? i * cage_vertices / k : i);
  }
  const std::vector<Vec3> by(cage_vertices, Vec3(1e-3, 2e-3, 3e-3));
  double best_some = 1e9;
  double best_all = 1e9;
  double best_read = 1e9;
  std::vector<double> sums(weights().tile_count());
  tbb::task_arena arena(1);
  for (auto _ : state) {
    arena.execute([&] {
      keep_best(best_read, [&] { read_all(weights(), sums); });
      keep_best(best_all, [&] { move_points(tiles, all, by, rest, moved); });
      move_points(tiles, some, std::span(by).first(k), moved, moved); // as in the middle of a drag
      keep_best(best_some, [&] { move_points(tiles, some, std::span(by).first(k), moved, moved); });
    });
  }
  const double share = static_cast<double>(k) / cage_vertices;
  const double whole = k == cage_vertices ? best_all : best_some;
  const double position_bytes = (k == cage_vertices ? 3.0 : 2.0) * points * sizeof(Vec3);
  const double bytes = static_cast<double>(tiles.bytes()) * share + position_bytes;
  state.counters["ms"] = 1e3 * whole;
  state.counters["of_share"] = whole / (share * best_all);
  state.counters["speed"] = bytes / whole * best_read / static_cast<double>(weights().bytes());
}

void move_some(benchmark::State& state) {
  share_of(state, weights());
}
void move_some_compact(benchmark::State& state) {
  share_of(state, compact_weights());
}

/// Positions and normals of a real surface, as an application sees it.
void update_deformer(benchmark::State& state) {
  const PolygonMesh model(make_torus(0.25, 500, 200));
  const PolygonMesh cage(make_torus(0.4, 20, 10));
  Deformer deformer = *Deformer::bind(model, cage, {.normals = state.range(1) != 0});
  const auto k = static_cast<std::size_t>(state.range(0));
  double step = 0;
  for (auto _ : state) {
    step = step > 0 ? 0.0 : 0.01;
    for (Index v = 0; v < k; ++v) {
      deformer.move_cage_vertex(v, cage.positions[v] + Vec3(step, 0, step));
    }
    deformer.update();
    benchmark::DoNotOptimize(deformer.positions().data());
  }
}

BENCHMARK(read_memory)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(move_all)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(
    benchmark::kMillisecond);
BENCHMARK(move_all_compact)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(move_some)
    ->ArgNames({"moved", "spread"})
    ->ArgsProduct({{1, 4, 10, 25, 50, 100, 199}, {0, 1}})
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(move_some_compact)
    ->ArgNames({"moved", "spread"})
    ->ArgsProduct({{10, 50, 199}, {1}})
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(update_deformer)
    ->ArgNames({"moved", "normals"})
    ->ArgsProduct({{1, 20, 200}, {0, 1}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace cagewright
