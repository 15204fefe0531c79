#include "envelope/envelope.h"
#include "improve/improve.h"
#include "mesh/shapes.h"
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>

namespace {

using namespace cagewright;

/// A torus with bumps, so that there is something to follow; 2 around^2 triangles or so.
TriangleMesh bumpy_torus(Index around) {
  TriangleMesh mesh = make_torus(0.35, around, around / 2);
  for (Vec3& p : mesh.positions) {
    const double bump = std::sin(7 * p.x()) * std::sin(5 * p.y()) * std::sin(6 * p.z());
    p *= 1 + 0.1 * bump;
  }
  return mesh;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// How the time to a cage of 100 vertices grows with the model's triangles, and how it splits; the
/// quality beside it.
void cage_by_model_size(benchmark::State& state) {
  const TriangleMesh model = bumpy_torus(static_cast<Index>(state.range(0)));
  Improved made;
  double envelope_seconds = 0;
  double check_seconds = 0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    const Envelope start = *envelope(model);
    envelope_seconds = seconds_since(begin);
    made = *improve(start.mesh, model);
    const auto end = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(validate_cage(made.cage, model));
    check_seconds = seconds_since(end);
  }
  const CageMetrics metrics = measure_cage(made.cage, model);
  state.counters["triangles"] = static_cast<double>(model.triangles.size());
  state.counters["envelope_s"] = envelope_seconds;
  state.counters["check_s"] = check_seconds;
  state.counters["simplify_s"] = made.report.simplify_seconds;
  state.counters["refine_s"] = made.report.refine_seconds;
  state.counters["ratio"] = metrics.volume_ratio;
  state.counters["mean_d"] = metrics.mean_distance;
}
BENCHMARK(cage_by_model_size)
    ->ArgName("around")
    ->Arg(60)
    ->Arg(180)
    ->Arg(316)
    ->Arg(600)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// How it grows with the budget.
void cage_by_budget(benchmark::State& state) {
  const TriangleMesh model = bumpy_torus(120);
  const auto vertices = static_cast<int>(state.range(0));
  Improved made;
  for (auto _ : state) {
    const Envelope start = *envelope(model, {.vertices = vertices});
    made = *improve(start.mesh, model, {.vertices = vertices});
  }
  const CageMetrics metrics = measure_cage(made.cage, model);
  state.counters["simplify_s"] = made.report.simplify_seconds;
  state.counters["refine_s"] = made.report.refine_seconds;
  state.counters["ratio"] = metrics.volume_ratio;
  state.counters["mean_d"] = metrics.mean_distance;
  state.counters["least_quality"] = metrics.min_quality;
}
BENCHMARK(cage_by_budget)
    ->ArgName("vertices")
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Arg(400)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
