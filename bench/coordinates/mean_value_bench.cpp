// Cost of binding, per pair of a point and a cage triangle: our kernel on each instruction set,
// beside the formula as published, in the same run.

#include "published_formula.h"

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/mean_value.h>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cagewright {
namespace {

/// T = 2 * around * across triangles.
TriangleMesh cage_of(std::int64_t triangles) {
  switch (triangles) {
  case 100:
    return make_torus(0.35, 10, 5);
  case 400:
    return make_torus(0.35, 20, 10);
  default:
    return make_torus(0.35, 40, 20);
  }
}

/// The vertices of a finer torus inside, at about 3 % of the diagonal from the cage: model
/// vertices, in the order of a mesh.
std::vector<Vec3> points_of(std::int64_t count) {
  return make_torus(0.25, static_cast<Index>(count / 32), 32).positions;
}

enum class Kind { published, exact, stored, preview };

void bind(benchmark::State& state, Kind kind, std::int64_t targets) {
  const TriangleMesh cage = cage_of(state.range(0));
  const std::vector<Vec3> points = points_of(state.range(1));
  const MeanValueSolver solver = *MeanValueSolver::create(TriangleView(cage));
  hwy::SetSupportedTargetsForTest(targets);
  std::vector<double> doubles(16 * cage.positions.size());
  std::vector<float> floats(16 * cage.positions.size());
  std::vector<double> distance;
  std::vector<Vec3> direction;
  for (auto _ : state) {
    for (std::size_t first = 0; first < points.size(); first += 16) {
      const std::span<const Vec3> tile = std::span(points).subspan(first, 16);
      if (kind == Kind::exact) {
        solver.solve(tile, doubles);
      } else if (kind == Kind::stored) {
        solver.solve(tile, floats);
      } else if (kind == Kind::preview) {
        solver.preview(tile, floats);
      } else {
        for (const Vec3& p : tile) {
          bench::published_weights(cage, p, std::span(doubles).first(cage.positions.size()),
                                   distance, direction);
        }
      }
      benchmark::DoNotOptimize(doubles.data());
      benchmark::DoNotOptimize(floats.data());
      benchmark::ClobberMemory();
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  const double pairs = static_cast<double>(points.size() * cage.triangles.size());
  state.counters["ns_per_pair"] = benchmark::Counter(
      pairs * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// All points on a number of threads, into one matrix of floats.
void bind_all(benchmark::State& state) {
  const TriangleMesh cage = cage_of(400);
  const std::vector<Vec3> points = points_of(state.range(0));
  const MeanValueSolver solver = *MeanValueSolver::create(TriangleView(cage));
  tbb::task_arena arena(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    arena.execute([&] {
      auto solved = solve_all<float>(solver, points);
      benchmark::DoNotOptimize(solved->weights.tile(0).data());
    });
  }
  const double pairs = static_cast<double>(points.size() * cage.triangles.size());
  state.counters["ns_per_pair"] = benchmark::Counter(
      pairs * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void prepare(benchmark::State& state) {
  const TriangleMesh cage = cage_of(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(MeanValueSolver::create(TriangleView(cage)));
  }
}

const bool registered = [] {
  const auto add = [](const std::string& name, Kind kind, std::int64_t targets) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) { bind(state, kind, targets); })
        ->ArgNames({"triangles", "points"})
        ->Args({100, 2048})
        ->Args({400, 2048})
        ->Args({1600, 2048})
        ->Args({400, 8192})
        ->Unit(benchmark::kMillisecond);
  };
  add("Bind/published", Kind::published, 0);
  // The targets are bits, the best the lowest: take away the best, one after the other.
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::string name = hwy::TargetName(targets & -targets);
    if (name == "SSSE3" || name == "AVX3_DL" || name == "EMU128") {
      continue; // not compiled
    }
    add("Bind/double/" + name, Kind::exact, targets);
    add("Bind/double_to_float/" + name, Kind::stored, targets);
    add("Bind/preview/" + name, Kind::preview, targets);
  }
  return true;
}();

BENCHMARK(bind_all)
    ->ArgNames({"points", "threads"})
    ->ArgsProduct({{16384, 131072}, {1, 2, 4}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(prepare)->Arg(100)->Arg(400)->Arg(1600)->Unit(benchmark::kMicrosecond);

} // namespace
} // namespace cagewright
