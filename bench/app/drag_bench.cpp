// A drag in deform mode from the moved cage vertices to the new picture, apart from the rasteriser:
// the model's layer is switched off, so that all is computed and uploaded, and little is drawn.
//
//     xvfb-run -a -s "-screen 0 1920x1200x24" bench/app_drag_bench
#include "app/document/binding.h"
#include "app/jobs/deform_loop.h"
#include "app/view/viewport.h"
#include "mesh/shapes.h"

#include <QApplication>
#include <QTest>

#include <benchmark/benchmark.h>

#include <numeric>

namespace cagewright::app {
namespace {

/// A ball in a cage of 162 vertices, of which `moved` go to and fro.
void BM_drag_of_cage_162(benchmark::State& state) {
  const TriangleMesh ball = make_icosphere(static_cast<int>(state.range(0)));
  const auto moved = static_cast<std::size_t>(state.range(1));
  TriangleMesh cage = make_icosphere(2);
  for (Vec3& p : cage.positions) {
    p *= 1.1;
  }
  Document document;
  Editor editor(document);
  DeformLoop loop(document);
  document.set_model(*prepare_model(PolygonMesh(ball), {}));
  auto rest = std::make_shared<const PolygonMesh>(cage);
  editor.replace_cage(rest, nullptr, "cage");
  const auto start = std::chrono::steady_clock::now();
  Result<Deformer> deformer =
      Deformer::bind(document.model()->mesh, *rest, {.storage = WeightStorage::compact});
  const auto bound = std::chrono::steady_clock::now();
  editor.bind(std::make_shared<const Binding>(*std::move(deformer), CoordinateSettings(),
                                              *prepare_coordinates(*rest)),
              rest);
  Viewport view(editor);
  view.resize(320, 240);
  view.show();
  if (!QTest::qWaitForWindowExposed(&view)) {
    state.SkipWithError("no window");
    return;
  }
  Layers layers;
  layers.model = false;
  document.set_layers(layers);
  loop.finish();
  view.grabFramebuffer();

  std::vector<Index> vertices(std::min(moved, cage.positions.size()));
  std::iota(vertices.begin(), vertices.end(), Index{0});
  editor.begin_move(vertices);
  double step = 0;
  double updates = 0;
  for (auto _ : state) {
    step += 0.001;
    std::vector<Vec3> to;
    for (const Index v : vertices) {
      to.emplace_back(cage.positions[v] * (1 + 0.1 * std::sin(step)));
    }
    editor.move_to(to);
    loop.finish();
    updates += loop.last_update_seconds();
    view.grabFramebuffer();
  }
  editor.cancel_move();
  loop.finish();
  state.counters["vertices"] = static_cast<double>(ball.positions.size());
  state.counters["deform_ms"] =
      1000 * updates /
      static_cast<double>(std::max<benchmark::IterationCount>(1, state.iterations()));
  state.counters["bind_s"] = std::chrono::duration<double>(bound - start).count();
}
BENCHMARK(BM_drag_of_cage_162)
    ->Args({7, 1})
    ->Args({7, 20})
    ->Args({7, 162})
    ->Args({8, 20})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// Drawing a model of 1.3 million triangles on this machine.
void BM_draw_1310720_triangles(benchmark::State& state) {
  Document document;
  Editor editor(document);
  document.set_model(*prepare_model(PolygonMesh(make_icosphere(8)), {}));
  Viewport view(editor);
  view.resize(640, 480);
  view.show();
  if (!QTest::qWaitForWindowExposed(&view)) {
    state.SkipWithError("no window");
    return;
  }
  view.grabFramebuffer();
  for (auto _ : state) {
    view.grabFramebuffer();
  }
}
BENCHMARK(BM_draw_1310720_triangles)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

} // namespace
} // namespace cagewright::app

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  QApplication application(argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
