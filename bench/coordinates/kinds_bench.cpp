// Cost of binding by each kind of coordinates, per pair of a point and a cage triangle, on one
// thread: points of a torus inside a torus of 100 vertices and 200 triangles.

#include "mesh/shapes.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <benchmark/benchmark.h>

#include <span>
#include <string>
#include <vector>

namespace cagewright {
namespace {

const PolygonMesh& cage() {
  static const PolygonMesh made(make_torus(0.4, 10, 10));
  return made;
}

void bind(benchmark::State& state, const CoordinateKind* kind) {
  const std::vector<Vec3> points = make_torus(0.25, 64, 16).positions;
  const auto coordinates = prepare_coordinates(cage(), CoordinateSettings(*kind));
  if (!coordinates) {
    state.SkipWithError(coordinates.error().message.c_str());
    return;
  }
  std::vector<double> weights(16 * (*coordinates)->columns());
  for (auto _ : state) {
    for (std::size_t first = 0; first < points.size(); first += 16) {
      (*coordinates)->solve(std::span(points).subspan(first, 16), weights);
      benchmark::DoNotOptimize(weights.data());
      benchmark::ClobberMemory();
    }
  }
  const double pairs = static_cast<double>(points.size() * cage().face_count());
  state.counters["ns_per_pair"] = benchmark::Counter(
      pairs * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void prepare(benchmark::State& state, const CoordinateKind* kind) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(prepare_coordinates(cage(), CoordinateSettings(*kind)));
  }
}

const bool registered = [] {
  for (const CoordinateKind* kind : coordinate_kinds()) {
    const std::string name(kind->name);
    benchmark::RegisterBenchmark(("Kind/" + name).c_str(), bind, kind)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("Prepare/" + name).c_str(), prepare, kind)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

} // namespace
} // namespace cagewright
