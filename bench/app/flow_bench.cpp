// The whole way in the real window, from a file to an exported model and back, on a model of a
// million triangles: how long each step takes, and the longest turn of the event loop meanwhile, by
// the clock and by the work of the window's own thread.
//
//     xvfb-run -a -s "-screen 0 1920x1200x24" bench/app_flow_bench
//
// The second number of a name is 1 where the model is drawn, by the processor if there is no
// graphics card, and 0 where its surface is left out.
#include "app/application.h"
#include "app/main_window.h"
#include "app/view/viewport.h"
#include "mesh/shapes.h"
#include "mouse.h"
#include <cagewright/io/write_mesh.h>

#include <QAction>
#include <QElapsedTimer>
#include <QSettings>
#include <QSurfaceFormat>
#include <QTemporaryDir>
#include <QTest>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

namespace cagewright::app {
namespace {

/// A bumpy torus of 2 * around * across triangles.
PolygonMesh bumpy_torus(Index around, Index across) {
  TriangleMesh mesh = make_torus(0.35, around, across);
  for (Vec3& p : mesh.positions) {
    p *= 1 + 0.08 * std::sin(9 * p.x()) * std::cos(7 * p.y()) + 0.01 * std::sin(60 * p.z());
  }
  return PolygonMesh(mesh);
}

class Flow {
public:
  explicit Flow(benchmark::State& state)
      : state_(state), window_(QDir(folder_.filePath("autosave"))) {
    window_.resize(1280, 800);
    window_.show();
    if (!QTest::qWaitForWindowExposed(&window_)) {
      state.SkipWithError("no window");
    }
  }

  Session& session() { return window_.session(); }
  Document& document() { return session().document(); }
  Editor& editor() { return session().editor(); }
  Viewport& view() { return window_.viewport(); }
  QString path(const char* name) const { return folder_.filePath(name); }

  void change_layers(const std::function<void(Layers&)>& change) {
    Layers layers = document().layers();
    change(layers);
    document().set_layers(layers);
  }
  void press(const char* action) { window_.findChild<QAction*>(action)->trigger(); }
  void take_tool(Tool tool) {
    ToolSettings tools = document().tools();
    tools.tool = tool;
    document().set_tools(tools);
  }
  /// Does something, then lets the window live until `done`, and until the picture is as fine as it
  /// gets.
  void step(const std::string& name, const std::function<void()>& act,
            const std::function<bool()>& done) {
    application().forget_turns();
    QElapsedTimer clock;
    clock.start();
    act();
    while (!done() && clock.elapsed() < 600000) {
      QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
    }
    const double seconds = static_cast<double>(clock.elapsed()) / 1000;
    const auto is_fine = [this] {
      return view().canvas() == nullptr || !view().canvas()->can_improve();
    };
    while (static_cast<double>(clock.elapsed()) < 1000 * seconds + 600 ||
           !is_fine()) { // what comes after: repainting
      QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
    }
    const auto& longest = application().longest_turn();
    const auto& hardest = application().hardest_turn();
    std::printf("%-16s %7.2f s  longest turn %4.0f ms (%s), hardest %4.0f ms (%s)\n", name.c_str(),
                seconds, longest.milliseconds, qPrintable(longest.what), hardest.work,
                qPrintable(hardest.what));
    std::fflush(stdout);
    state_.counters[name + "_ms"] = longest.milliseconds;
    state_.counters[name + "_work_ms"] = hardest.work;
  }
  void wait_for_job(const std::string& name, const std::function<void()>& act) {
    step(name, act, [this] { return !session().jobs().busy() && !session().checker().busy(); });
  }
  /// Thirty movements of the mouse, with what comes of each.
  void move_about(QPoint from, Qt::MouseButton button) {
    test::move_mouse(view(), from);
    QTest::mousePress(&view(), button, {}, from);
    for (int i = 1; i <= 30; ++i) {
      test::move_mouse(view(), from + QPoint(4 * i, 2 * i), button);
      QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
    }
    QTest::mouseRelease(&view(), button, {}, from + QPoint(120, 60));
  }
  void by_mouse(const std::string& name, QPoint from, Qt::MouseButton button) {
    step(
        name, [&] { move_about(from, button); }, [this] { return !session().checker().busy(); });
    session().deform_loop().finish();
  }
  /// Drags `count` vertices to and fro, thirty movements of the mouse.
  void drag(const std::string& name, std::size_t count) {
    std::vector<Index> vertices(std::min(count, document().cage_positions().size()));
    for (Index v = 0; v < vertices.size(); ++v) {
      vertices[v] = v;
    }
    const std::vector<Vec3> start(document().cage_positions().begin(),
                                  document().cage_positions().end());
    const double way = 0.02 * document().diagonal();
    int moves = 0;
    step(
        name,
        [&] {
          QMetaObject::invokeMethod(
              &view(), [&] { editor().begin_move(vertices); }, Qt::QueuedConnection);
        },
        [&] {
          std::vector<Vec3> to;
          for (const Index v : vertices) {
            to.push_back(start[v] + way * std::sin(0.2 * moves) * Vec3::UnitX());
          }
          QMetaObject::invokeMethod(
              &view(), [this, to] { editor().move_to(to); }, Qt::QueuedConnection);
          QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
          return ++moves == 30;
        });
    in_turn(name + "_end", [&] { editor().end_move("Move"); });
    session().deform_loop().finish();
  }
  /// As from a menu.
  void in_turn(const std::string& name, const std::function<void()>& act) {
    bool acted = false;
    step(
        name,
        [&] {
          QMetaObject::invokeMethod(
              &view(),
              [&] {
                act();
                acted = true;
              },
              Qt::QueuedConnection);
        },
        [&] { return acted && !session().jobs().busy() && !session().checker().busy(); });
  }

private:
  static Application& application() { return *static_cast<Application*>(qApp); }

  benchmark::State& state_;
  QTemporaryDir folder_;
  MainWindow window_;
};

void BM_flow(benchmark::State& state) {
  for (auto _ : state) {
    Flow flow(state);
    if (!write_mesh(bumpy_torus(static_cast<Index>(state.range(0)), 500),
                    flow.path("model.ply").toStdString())) {
      state.SkipWithError("cannot write the model");
      return;
    }
    flow.change_layers([&](Layers& l) { l.model = state.range(1) != 0; });
    const auto with = [&](const auto& change) {
      return [&flow, change] { flow.change_layers(change); };
    };
    const auto open = [&](const char* name) {
      return [&flow, name] { flow.session().open(flow.path(name).toStdString()); };
    };
    flow.in_turn("open", open("model.ply"));
    flow.by_mouse("orbit", {500, 300}, Qt::MiddleButton);
    flow.in_turn("back", [&] { flow.view().set_standard_view("back"); });
    flow.in_turn("wireframe", with([](Layers& l) { l.wireframe = true; }));
    flow.in_turn("flat", with([](Layers& l) { l.wireframe = l.smooth_normals = false; }));
    flow.in_turn("smooth", with([](Layers& l) { l.smooth_normals = true; }));
    flow.take_tool(Tool::paint);
    flow.by_mouse("paint", {400, 250}, Qt::LeftButton);
    flow.in_turn("undo_paint", [&] { flow.editor().undo_stack().undo(); });
    flow.take_tool(Tool::select_box);
    flow.in_turn("generate", [&] { flow.session().generate(); });
    flow.by_mouse("box", {200, 100}, Qt::LeftButton);
    flow.in_turn("select_all", [&] { flow.press("select_all"); });
    flow.drag("refine_1", 1);
    flow.drag("refine_all", 100000);
    flow.in_turn("undo", [&] { flow.editor().undo_stack().undo(); });
    flow.in_turn("distance", with([](Layers& l) { l.distance = true; }));
    flow.drag("distance_1", 1);
    flow.change_layers([](Layers& l) { l.distance = false; });
    flow.in_turn("bind", [&] { flow.session().bind(); });
    flow.in_turn("weights", with([](Layers& l) { l.weights = true; }));
    flow.change_layers([](Layers& l) { l.weights = false; });
    flow.drag("deform_1", 1);
    flow.drag("deform_all", 100000);
    flow.take_tool(Tool::pull);
    flow.by_mouse("pull", {500, 300}, Qt::LeftButton);
    flow.in_turn("pose", [&] { flow.editor().add_pose("pose"); });
    flow.in_turn("undo_all", [&] {
      for (int i = 0; i < 5; ++i) {
        flow.editor().undo_stack().undo();
      }
    });
    flow.in_turn("redo_all", [&] {
      for (int i = 0; i < 5; ++i) {
        flow.editor().undo_stack().redo();
      }
    });
    flow.in_turn("compare", [&] { flow.document().set_comparing(true); });
    flow.document().set_comparing(false);
    flow.in_turn("export",
                 [&] { flow.session().export_model(flow.path("out.ply").toStdString()); });
    flow.in_turn("save",
                 [&] { flow.session().save_project(flow.path("a.cagewright").toStdString()); });
    flow.in_turn("refine", [&] { flow.session().refine(); });
    flow.in_turn("reopen", open("a.cagewright"));
    flow.in_turn("another", open("model.ply"));
    state.counters["triangles"] = static_cast<double>(flow.document().model_triangles().size());
  }
}
BENCHMARK(BM_flow)
    ->ArgsProduct({{100, 1000}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

} // namespace
} // namespace cagewright::app

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
  cagewright::app::Application application(argc, argv);
  const QTemporaryDir settings; // nobody's own settings are touched
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
  QCoreApplication::setOrganizationName("Cagewright");
  QCoreApplication::setApplicationName("CagewrightBench");
  QSettings().setValue("ask_before_closing", false);
  cagewright::app::test::park_cursor();
  benchmark::RunSpecifiedBenchmarks();
}
