#include "cage/decompose.h"

#include "mesh/shapes.h"

#include <benchmark/benchmark.h>

namespace {

using namespace cagewright;

/// Everything before the union, at the default resolution and depth.
void decompose_torus(benchmark::State& state) {
  const auto around = static_cast<Index>(state.range(0));
  const TriangleMesh model = make_torus(0.35, around, around / 2);
  double voxels = 0;
  double slicing = 0;
  for (auto _ : state) {
    const BoxDecomposition made = *decompose(model);
    voxels = made.times[0].seconds + made.times[1].seconds;
    slicing = made.times[2].seconds;
  }
  state.counters["triangles"] = static_cast<double>(model.triangles.size());
  state.counters["voxels_s"] = voxels;
  state.counters["slicing_s"] = slicing;
}
BENCHMARK(decompose_torus)
    ->ArgName("around")
    ->Arg(100)
    ->Arg(316)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
