// The whole way in the real window, from a file to an exported model and back, on a model of a
// million triangles: how long each step takes, and the longest time for which the window did not
// answer meanwhile. Drawing the model's surface is the graphics card's business and left out,
// unless the name says drawn.
//
//     xvfb-run -a -s "-screen 0 1920x1200x24" bench/app_flow_bench
#include "app/main_window.h"
#include "app/view/viewport.h"
#include "mesh/shapes.h"
#include <cagewright/io/write_mesh.h>

#include <QApplication>
#include <QElapsedTimer>
#include <QSettings>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>

#include <benchmark/benchmark.h>

#include <time.h>

#include <algorithm>
#include <cmath>
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

double now_ms(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return 1000 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) / 1e6;
}

/// Beats every 2 ms while the window answers.
class Heartbeat {
public:
  Heartbeat() {
    timer_.setTimerType(Qt::PreciseTimer);
    QObject::connect(&timer_, &QTimer::timeout, [this] { beat(); });
    timer_.start(2);
  }
  void restart() {
    beat();
    longest_ = work_ = 0;
  }
  void beat() {
    const double time = now_ms(CLOCK_MONOTONIC);
    const double cpu = now_ms(CLOCK_THREAD_CPUTIME_ID);
    longest_ = std::max(longest_, time - last_);
    work_ = std::max(work_, cpu - last_cpu_);
    last_ = time;
    last_cpu_ = cpu;
  }
  /// Between two beats, in milliseconds.
  [[nodiscard]] double longest() const { return longest_; }
  [[nodiscard]] double work() const { return work_; }

private:
  QTimer timer_;
  double last_ = now_ms(CLOCK_MONOTONIC);
  double last_cpu_ = now_ms(CLOCK_THREAD_CPUTIME_ID);
  double longest_ = 0;
  double work_ = 0;
};

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
  QString path(const char* name) const { return folder_.filePath(name); }

  void show_model(bool on) {
    Layers layers = document().layers();
    layers.model = on;
    document().set_layers(layers);
  }
  /// Does something, then lets the window live until `done`.
  void step(const std::string& name, const std::function<void()>& act,
            const std::function<bool()>& done) {
    heartbeat_.restart();
    QElapsedTimer clock;
    clock.start();
    act();
    while (!done() && clock.elapsed() < 600000) {
      QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
    }
    for (int i = 0; i < 20; ++i) { // what comes after: repainting
      QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
    }
    state_.counters[name + "_s"] = static_cast<double>(clock.elapsed()) / 1000;
    heartbeat_.beat();
    state_.counters[name + "_gap_ms"] = heartbeat_.longest();
    state_.counters[name + "_work_ms"] = heartbeat_.work();
  }
  void wait_for_job(const std::string& name, const std::function<void()>& act) {
    step(name, act, [this] { return !session().jobs().busy() && !session().checker().busy(); });
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
        name, [&] { editor().begin_move(vertices); },
        [&] {
          std::vector<Vec3> to;
          for (const Index v : vertices) {
            to.push_back(start[v] + way * std::sin(0.2 * moves) * Vec3::UnitX());
          }
          editor().move_to(to);
          QCoreApplication::processEvents(QEventLoop::AllEvents, 5);
          return ++moves == 30;
        });
    step(
        name + "_end", [&] { editor().end_move("Move"); },
        [this] { return !session().checker().busy(); });
    session().deform_loop().finish();
  }

private:
  benchmark::State& state_;
  QTemporaryDir folder_;
  MainWindow window_;
  Heartbeat heartbeat_;
};

void BM_flow(benchmark::State& state) {
  for (auto _ : state) {
    Flow flow(state);
    if (!write_mesh(bumpy_torus(static_cast<Index>(state.range(0)), 500),
                    flow.path("model.ply").toStdString())) {
      state.SkipWithError("cannot write the model");
      return;
    }
    flow.show_model(false);
    flow.wait_for_job("open", [&] { flow.session().open(flow.path("model.ply").toStdString()); });
    flow.wait_for_job("generate", [&] { flow.session().generate(); });
    flow.drag("refine_1", 1);
    flow.drag("refine_all", 100000);
    flow.step(
        "undo", [&] { flow.editor().undo_stack().undo(); },
        [&] { return !flow.session().checker().busy(); });
    flow.wait_for_job("bind", [&] { flow.session().bind(); });
    flow.drag("deform_1", 1);
    flow.drag("deform_all", 100000);
    flow.show_model(true);
    flow.drag("drawn_1", 1);
    flow.show_model(false);
    flow.editor().add_pose("pose");
    flow.wait_for_job("export",
                      [&] { flow.session().export_model(flow.path("out.ply").toStdString()); });
    flow.step(
        "save", [&] { flow.session().save_project(flow.path("a.cagewright").toStdString()); },
        [] { return true; });
    flow.wait_for_job("reopen",
                      [&] { flow.session().open(flow.path("a.cagewright").toStdString()); });
    state.counters["triangles"] = static_cast<double>(flow.document().model_triangles().size());
    state.counters["cage_vertices"] = static_cast<double>(flow.document().cage_positions().size());
  }
}
BENCHMARK(BM_flow)->Arg(100)->Arg(1000)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();

} // namespace
} // namespace cagewright::app

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  QApplication application(argc, argv);
  const QTemporaryDir settings; // nobody's own settings are touched
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
  QCoreApplication::setOrganizationName("Cagewright");
  QCoreApplication::setApplicationName("CagewrightBench");
  QSettings().setValue("ask_before_closing", false);
  benchmark::RunSpecifiedBenchmarks();
}
