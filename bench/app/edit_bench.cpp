// What a movement of the mouse costs, apart from drawing.
#include "app/edit/cage_graph.h"
#include "app/edit/cage_watch.h"
#include "app/edit/pick.h"
#include "app/edit/transform.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <benchmark/benchmark.h>

#include <memory>
#include <numeric>

namespace cagewright::app {
namespace {

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& p : mesh.positions) {
    p *= factor;
  }
  return mesh;
}

/// A cage of 320 triangles close round a ball of `triangles`; `moved` of its vertices go to and
/// fro.
void BM_watch_cage_320(benchmark::State& state) {
  const int subdivisions = static_cast<int>(state.range(0));
  const auto moved = static_cast<Index>(state.range(1));
  const TriangleMesh ball = make_icosphere(subdivisions);
  const PolygonMesh cage(scaled(make_icosphere(2), 1.04));
  CageWatch watch(cage, std::make_shared<const WatchedModel>(ball));
  std::vector<Index> vertices(std::min<std::size_t>(moved, cage.positions.size()));
  std::iota(vertices.begin(), vertices.end(), Index{0});
  double step = 0;
  for (auto _ : state) {
    step = step == 0 ? 0.002 : 0;
    std::vector<Vec3> to;
    for (const Index v : vertices) {
      to.emplace_back(cage.positions[v] * (1 + step));
    }
    watch.move(vertices, to);
    benchmark::DoNotOptimize(watch.is_valid());
  }
  state.counters["model_triangles"] = static_cast<double>(ball.triangles.size());
  state.counters["valid"] = watch.is_valid() ? 1 : 0;
}
BENCHMARK(BM_watch_cage_320)
    ->Args({6, 1})
    ->Args({6, 10})
    ->Args({6, 1000})
    ->Args({8, 1})
    ->Args({8, 1000})
    ->Unit(benchmark::kMillisecond);

void BM_pick_vertex_of_20480_faces(benchmark::State& state) {
  const PolygonMesh cage(make_icosphere(5));
  const CageGraph graph(cage);
  OrbitCamera camera;
  const Box3 box = bounding_box(cage.positions);
  camera.set_scene(box);
  camera.frame(box);
  const Picker picker(cage, graph);
  for (auto _ : state) {
    benchmark::DoNotOptimize(picker.pick(camera, {300, 250}, SelectionMode::vertex));
  }
}
BENCHMARK(BM_pick_vertex_of_20480_faces)->Unit(benchmark::kMillisecond);

void BM_make_picker_of_20480_faces(benchmark::State& state) {
  const PolygonMesh cage(make_icosphere(5));
  const CageGraph graph(cage);
  for (auto _ : state) {
    benchmark::DoNotOptimize(Picker(cage, graph));
  }
}
BENCHMARK(BM_make_picker_of_20480_faces)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace cagewright::app
