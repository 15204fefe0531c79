#include "mesh/shapes.h"
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

using namespace cagewright;

TriangleMesh ball(double radius, int subdivisions) {
  TriangleMesh sphere = make_icosphere(subdivisions);
  for (Vec3& p : sphere.positions) {
    p *= radius;
  }
  return sphere;
}

/// A torus of about range(0) triangles in a ball of 1,280.
void judge_a_ball_round_a_torus(benchmark::State& state) {
  const auto around = static_cast<Index>(std::sqrt(static_cast<double>(state.range(0))));
  const TriangleMesh model = make_torus(0.35, around, around / 2);
  const TriangleMesh cage = ball(1.5, 3);
  for (auto _ : state) {
    benchmark::DoNotOptimize(validate_cage(TriangleView(cage), model));
  }
  state.counters["triangles"] = static_cast<double>(model.triangles.size());
}
BENCHMARK(judge_a_ball_round_a_torus)
    ->ArgName("triangles")
    ->Arg(10'000)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void measure_a_ball_round_a_torus(benchmark::State& state) {
  const auto around = static_cast<Index>(std::sqrt(static_cast<double>(state.range(0))));
  const TriangleMesh model = make_torus(0.35, around, around / 2);
  const TriangleMesh cage = ball(1.5, 3);
  for (auto _ : state) {
    benchmark::DoNotOptimize(measure_cage(cage, model));
  }
  state.counters["triangles"] = static_cast<double>(model.triangles.size());
}
BENCHMARK(measure_a_ball_round_a_torus)
    ->ArgName("triangles")
    ->Arg(10'000)
    ->Arg(100'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
