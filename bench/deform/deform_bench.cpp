// Moving a bound model: how near to the memory's own speed, and what k of M cage vertices cost.

#include "coordinates/compact_weights.h"
#include "core/parallel.h"
#include "core/random.h"
#include "deform/apply.h"
#include "deform/deformer.h"
#include "mesh/shapes.h"

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
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

/// The yardstick: the same bytes, only read and summed.
void read_memory(benchmark::State& state) {
  const FloatWeights& w = weights();
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  std::vector<double> sums(w.tile_count());
  for (auto _ : state) {
    arena.execute([&] {
      parallel_for(0, w.tile_count(), 64, [&](std::size_t t) {
        const std::span<const float> tile = w.tile(t);
        std::array<float, 64> sum{};
        std::size_t i = 0;
        for (; i + 64 <= tile.size(); i += 64) {
          for (std::size_t k = 0; k < 64; ++k) {
            sum[k] += tile[i + k];
          }
        }
        sums[t] = sum[7] + sum[60];
      });
    });
    benchmark::DoNotOptimize(sums.data());
  }
  count_bytes(state, w.bytes());
}

/// Which of the cage's vertices are moved: neighbors in the order of the file, or every so many.
enum class Choice { adjacent, spread };

/// The bytes counted are those that must pass: the weights of the moved vertices, the rest and the
/// positions once read, the positions once written.
template <class SomeWeights>
void move(benchmark::State& state, const SomeWeights& tiles, std::size_t k, int threads,
          Choice choice = Choice::spread) {
  std::vector<Vec3> rest(points, Vec3(1, 2, 3));
  std::vector<Vec3> moved = rest;
  std::vector<Index> vertices(k);
  for (std::size_t i = 0; i < k; ++i) {
    vertices[i] = static_cast<Index>(choice == Choice::spread ? i * cage_vertices / k : i);
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
void move_some(benchmark::State& state) {
  move(state, weights(), static_cast<std::size_t>(state.range(0)), 1,
       state.range(1) != 0 ? Choice::spread : Choice::adjacent);
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
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(update_deformer)
    ->ArgNames({"moved", "normals"})
    ->ArgsProduct({{1, 20, 200}, {0, 1}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace cagewright
