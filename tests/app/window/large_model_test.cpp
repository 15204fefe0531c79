// The window answers at once, however large the model: nothing that is done with it keeps the
// window's own thread busy for long. Measured as that thread's work, which does not depend on what
// else the machine has to do, and by a yardstick, which is as slow as the machine is.
#include "app/application.h"
#include "app/document/model.h"
#include "window_fixture.h"

#include <QMenu>
#include <QToolButton>

#include <oneapi/tbb/task_arena.h>

#include <ctime>

namespace cagewright::app {
namespace {

class LargeModel : public Window {
protected:
  /// What may pass from one answer to the next, as a share of the work of preparing the model,
  /// which is done beside the window. The model has a fifth of a million triangles: on a machine of
  /// today it is some 60 ms, and a tenth of a second is felt.
  static constexpr double most_share = 0.5;

  void SetUp() override {
    Window::SetUp();
    TriangleMesh torus = make_torus(0.35, 500, 200);
    for (Vec3& p : torus.positions) {
      p *= 1 + 0.08 * std::sin(9 * p.x()) * std::cos(7 * p.y());
    }
    ASSERT_TRUE(write_mesh(PolygonMesh(torus), path("model.ply").toStdString()));
    ASSERT_TRUE(write_mesh(PolygonMesh(make_torus(0.62, 16, 8)), path("cage.obj").toStdString()));
    most_work_ = most_share * std::min(work_of_preparing(torus), work_of_preparing(torus));
  }

  /// Milliseconds of one thread.
  static double work_of_preparing(const TriangleMesh& mesh) {
    const std::clock_t begin = std::clock();
    tbb::task_arena(1).execute([&] { EXPECT_TRUE(prepare_model(PolygonMesh(mesh), {})); });
    return 1000 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }

  static Application& application() { return *static_cast<Application*>(qApp); }

  /// What was done since the last question, and what comes of it until all is drawn.
  void expect_answers(const char* what) {
    ASSERT_TRUE(wait_until([this] {
      return !session().jobs().busy() && !session().checker().busy() &&
             view().canvas()->shows_all();
    }));
    const Application::Turn& turn = application().hardest_turn();
    EXPECT_LT(turn.work, most_work_) << what << ": " << turn.what.toStdString();
    application().forget_turns();
  }
  /// As an event of the window.
  void in_turn(const char* what, const std::function<void()>& act) {
    QMetaObject::invokeMethod(window.get(), act, Qt::QueuedConnection);
    QCoreApplication::processEvents();
    expect_answers(what);
  }
  void change_layers(const char* what, const std::function<void(Layers&)>& change) {
    in_turn(what, [&] {
      Layers layers = document().layers();
      change(layers);
      document().set_layers(layers);
    });
  }

private:
  double most_work_ = 0; // milliseconds
};

TEST_F(LargeModel, NeverKeepsTheWindowFromAnswering) {
  application().forget_turns(); // of the window that opens
  in_turn("open", [this] {
    session().open(path("model.ply").toStdString(), path("cage.obj").toStdString());
  });
  ASSERT_TRUE(document().has_cage());
  in_turn("another view", [this] { view().set_standard_view("back"); });
  change_layers("wireframe", [](Layers& l) { l.wireframe = true; });
  change_layers("flat", [](Layers& l) { l.wireframe = l.smooth_normals = false; });
  in_turn("select", [this] { trigger("select_all"); });
  drag({300, 300}, {340, 320}, {}, Qt::MiddleButton);
  expect_answers("orbit");
  in_turn("bind", [this] { session().bind(Session::Doubts::ignore); });
  ASSERT_EQ(document().mode(), Mode::deform);
  change_layers("weights", [](Layers& l) { l.weights = true; });
  change_layers("no weights", [](Layers& l) { l.weights = false; });
  const Vec3 to = document().cage_positions()[0] + Vec3(0.2, 0, 0);
  in_turn("drag", [this, to] {
    session().editor().begin_move({0});
    session().editor().move_to(std::vector<Vec3>{to});
  });
  in_turn("end of drag", [this] { session().editor().end_move("Move"); });
  in_turn("undo", [this] { session().editor().undo_stack().undo(); });
  in_turn("another kind", [this] {
    GenerateSettings settings = session().settings();
    settings.mixed = "green";
    session().set_settings(settings);
  });
  take_tool(Tool::mix);
  drag({500, 300}, {700, 340});
  expect_answers("paint a mix");
  ASSERT_TRUE(document().state().mix);
  in_turn("undo the mix", [this] { session().editor().undo_stack().undo(); });
  take_tool(Tool::pull);
  drag({500, 300}, {520, 310});
  expect_answers("drag the model");
  in_turn("keep a pose", [this] { session().editor().add_pose("a"); });
  in_turn("export", [this] { session().export_model(path("out.ply").toStdString()); });
  in_turn("save", [this] { session().save_project(path("a.cagewright").toStdString()); });
  in_turn("back to refining", [this] { session().refine(); });
  in_turn("hide", [this] { trigger("hide"); });
  in_turn("show all", [this] { trigger("reveal"); });
  in_turn("isolate", [this] { trigger("isolate"); });
  in_turn("delete", [this] { trigger("remove"); });
  change_layers("metal", [](Layers& l) { l.look = SurfaceLook::metal; });
  change_layers("its own colors", [](Layers& l) { l.look = SurfaceLook::own; });
  take_tool(Tool::paint);
  drag({500, 300}, {700, 340});
  expect_answers("paint");
  in_turn("undo the paint", [this] { session().editor().undo_stack().undo(); });
  take_tool(Tool::region);
  drag({500, 300}, {700, 340});
  expect_answers("paint a region");
  drag({2, 2}, {view().width() - 3, view().height() - 3}, Qt::ControlModifier);
  expect_answers("a lasso");
  in_turn("parts", [this] {
    QMetaObject::invokeMethod(find<QToolButton>("region")->menu(), "aboutToShow");
  });
  in_turn("project", [this] { session().open(path("a.cagewright").toStdString()); });
  in_turn("another model", [this] { session().open(path("model.ply").toStdString()); });
}

} // namespace
} // namespace cagewright::app
