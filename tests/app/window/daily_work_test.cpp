// What a day of work needs, by mouse and by keys.
#include "window_fixture.h"

#include "app/document/binding.h"
#include "app/panels/time_line_panel.h"
#include <cagewright/mesh/measures.h>

#include <QComboBox>
#include <QContextMenuEvent>
#include <QCoreApplication>
#include <QDialog>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QEnterEvent>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QToolButton>

#include <fstream>

namespace cagewright::app {
namespace {

class DailyWork : public Window {
protected:
  void click_frame(int frame) {
    if (find<QDockWidget>("dock_time_line")->isHidden()) {
      show_time_line();
    }
    auto* ruler = find<TimeRuler>("time_ruler");
    QTest::mouseClick(ruler, Qt::LeftButton, {},
                      QPoint(static_cast<int>(std::lround(ruler->x_of(frame))), 20));
    settle();
  }
  void drag_vertex(QPoint by) {
    const Index v = front_vertex();
    const QPoint from = at(document().shown_cage_positions()[v]);
    drag(from, from + by);
    settle();
  }
  std::vector<int> key_frames() {
    std::vector<int> frames;
    for (const Keyframe& key : document().state().time_line.keys) {
      frames.push_back(key.frame);
    }
    return frames;
  }
  void load_cage(const PolygonMesh& cage) {
    ASSERT_TRUE(write_mesh(cage, path("other.obj").toStdString()));
    session().load_cage(path("other.obj").toStdString());
    wait_for_job();
    ASSERT_TRUE(document().has_cage());
  }
  QMessageBox* question(const char* name) {
    QMessageBox* box = nullptr;
    EXPECT_TRUE(wait_until([&] {
      box = window->findChild<QMessageBox*>(name);
      return box != nullptr && box->isVisible();
    })) << name;
    return box;
  }
  void answer(QMessageBox* box, const char* button) {
    auto* found = box->findChild<QPushButton*>(button);
    ASSERT_NE(found, nullptr) << button;
    QTest::mouseClick(found, Qt::LeftButton);
  }
  /// Answers what is asked by act() with the button of that text; empty: by Escape.
  /// \returns what was asked
  QString answering(const QString& button, const std::function<void()>& act) {
    QString asked;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
      auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (box == nullptr || (!asked.isEmpty() && asked != box->text())) {
        return; // another question is another test's
      }
      asked = box->text(); // again until it is gone: its button may not be ready yet
      for (QAbstractButton* b : box->buttons()) {
        if (b->text() == button) {
          QTest::mouseClick(b, Qt::LeftButton);
          return;
        }
      }
      QTest::keyClick(box, Qt::Key_Escape);
    });
    timer.start(20);
    act();
    return asked;
  }
};

TEST_F(DailyWork, SetsAKeyframeAtEachFrameThatIsClicked) {
  open_model();
  generate();
  bind();
  click_frame(1);
  press_at_focus(Qt::Key_K);
  const std::vector<Vec3> rest = cage();
  click_frame(30);
  drag_vertex({50, 0});
  EXPECT_EQ(find<QSpinBox>("frame")->value(), 30) << "a drag does not move the frame";
  const std::vector<Vec3> second = cage();
  press_at_focus(Qt::Key_K);
  click_frame(60);
  drag_vertex({0, 40});
  const std::vector<Vec3> third = cage();
  press_at_focus(Qt::Key_K);
  ASSERT_EQ(key_frames(), (std::vector<int>{1, 30, 60}));
  const auto& keys = document().state().time_line.keys;
  EXPECT_EQ(*keys[0].positions, rest);
  EXPECT_EQ(*keys[1].positions, second);
  EXPECT_EQ(*keys[2].positions, third);

  click_frame(1);
  press_at_focus(Qt::Key_Space);
  ASSERT_TRUE(wait_until([this] { return document().frame() > 32; }));
  press_at_focus(Qt::Key_Space);
  EXPECT_FALSE(find<TimeRuler>("time_ruler")->isHidden());
  click_frame(30);
  EXPECT_EQ(std::vector<Vec3>(document().shown_cage_positions().begin(),
                              document().shown_cage_positions().end()),
            second);

  // Undo of a drag shows what was seen before it, at the same frame.
  drag_vertex({-30, 10});
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(find<QSpinBox>("frame")->value(), 30);
  EXPECT_LT(greatest_distance(document().shown_cage_positions(), second), 1e-12);
}

TEST_F(DailyWork, LettersWorkAfterAClickElsewhere) {
  open_model();
  generate();
  bind();
  click_frame(1);
  for (QWidget* other : std::initializer_list<QWidget*>{
           find<QSpinBox>("frame"), find<QListWidget>("poses"), find<TimeRuler>("time_ruler")}) {
    if (document().state().time_line.keys.empty()) {
      document().set_time(5);
    }
    other->setFocus();
    press_at_focus(Qt::Key_K);
    EXPECT_EQ(key_frames(), std::vector<int>{5}) << other->objectName().toStdString();
    session().editor().undo_stack().undo();
  }
  // Digits stay with a field.
  auto* frame = find<QSpinBox>("frame");
  frame->setFocus();
  frame->selectAll();
  QTest::keyClicks(frame, "12");
  QTest::keyClick(frame, Qt::Key_Return);
  EXPECT_EQ(document().frame(), 12);
  // The view has the keyboard as soon as the pointer is in it.
  // (An event of our own: the display's pointer may be in it already, and then none comes.)
  QEnterEvent enters({100, 100}, {100, 100}, view().mapToGlobal(QPointF(100, 100)));
  QCoreApplication::sendEvent(&view(), &enters);
  EXPECT_EQ(window->focusWidget(), &view());
}

TEST_F(DailyWork, SwitchesBetweenRefiningAndDeformingByTab) {
  open_model();
  generate();
  press_at_focus(Qt::Key_Tab);
  wait_for_job();
  ASSERT_EQ(document().mode(), Mode::deform);
  drag_vertex({40, 10});
  const std::vector<Vec3> posed = cage();
  press_at_focus(Qt::Key_Tab);
  ASSERT_EQ(document().mode(), Mode::refine);
  ASSERT_EQ(document().state().poses.size(), 1U) << "what was not kept is kept";
  EXPECT_EQ(document().state().poses[0].name, "Last pose");
  EXPECT_EQ(*document().state().poses[0].positions, posed);
  press_at_focus(Qt::Key_Tab);
  wait_for_job();
  session().editor().apply_pose(0);
  press_at_focus(Qt::Key_Tab);
  EXPECT_EQ(document().state().poses.size(), 1U) << "a pose that is kept is not kept twice";
}

TEST_F(DailyWork, TakesADragBackByEscapeAndByUndo) {
  open_model();
  generate();
  const std::vector<Vec3> before = cage();
  const int steps = session().editor().undo_stack().count();
  for (const bool undo : {false, true}) {
    const QPoint from = at(document().shown_cage_positions()[front_vertex()]);
    QTest::mousePress(&view(), Qt::LeftButton, {}, from);
    for (const QPoint p : {from + QPoint(10, 0), from + QPoint(40, 5)}) {
      QMouseEvent move(QEvent::MouseMove, p, view().mapToGlobal(p), Qt::NoButton, Qt::LeftButton,
                       {});
      QCoreApplication::sendEvent(&view(), &move);
    }
    ASSERT_TRUE(view().transforming());
    EXPECT_GT(greatest_distance(cage(), before), 1e-3);
    QTest::keyClick(&view(), undo ? Qt::Key_Z : Qt::Key_Escape,
                    undo ? Qt::ControlModifier : Qt::NoModifier);
    EXPECT_FALSE(view().transforming());
    EXPECT_EQ(cage(), before);
    QTest::mouseRelease(&view(), Qt::LeftButton, {}, from + QPoint(40, 5));
    EXPECT_EQ(cage(), before);
  }
  EXPECT_LE(session().editor().undo_stack().count(), steps + 1) << "but for the selection";
}

TEST_F(DailyWork, AsksBeforeItBindsACageThatIsNone) {
  open_model();
  generate();
  PolygonMesh inside_out;
  const PolygonMesh good = document().cage();
  inside_out.positions = good.positions;
  PolygonMesh apart; // each face with vertices of its own, a hair beside the others'
  PolygonMesh beside = good;
  for (std::size_t f = 0; f < good.face_count(); ++f) {
    std::vector<Index> corners(good.face(f).begin(), good.face(f).end());
    std::vector<Index> own;
    for (const Index v : corners) {
      own.push_back(static_cast<Index>(apart.positions.size()));
      apart.positions.push_back(good.positions[v] +
                                Vec3::Constant(1e-6 * static_cast<double>(f % 3)));
    }
    apart.add_face(own);
    std::reverse(corners.begin(), corners.end());
    inside_out.add_face(corners);
  }
  for (Vec3& p : beside.positions) {
    p += Vec3(30, 0, 0);
  }

  load_cage(inside_out);
  click("bind");
  wait_for_job();
  QMessageBox* box = question("binding_question");
  EXPECT_EQ(document().mode(), Mode::refine);
  EXPECT_TRUE(box->text().contains("inside out")) << box->text().toStdString();
  answer(box, "turn_outward");
  ASSERT_TRUE(wait_until([this] { return document().mode() == Mode::deform; }));
  wait_for_job();
  session().refine();

  load_cage(apart);
  click("bind");
  wait_for_job();
  box = question("binding_question");
  EXPECT_TRUE(box->text().contains("open edges")) << box->text().toStdString();
  answer(box, "weld");
  ASSERT_TRUE(wait_until([this] { return document().mode() == Mode::deform; }));
  EXPECT_EQ(document().cage_rest().positions.size(), good.positions.size());
  wait_for_job();
  session().refine();

  load_cage(beside);
  click("bind");
  wait_for_job();
  box = question("binding_question");
  EXPECT_TRUE(box->text().contains("outside")) << box->text().toStdString();
  answer(box, "bind_anyway");
  ASSERT_TRUE(wait_until([this] { return document().mode() == Mode::deform; }));
  session().refine();

  PolygonMesh other_unit = beside; // in centimetres, z up, and elsewhere
  for (Vec3& p : other_unit.positions) {
    p = 100 * Vec3(p.x(), -p.z(), p.y());
  }
  load_cage(other_unit);
  click("bind");
  wait_for_job();
  box = question("binding_question");
  EXPECT_TRUE(box->text().contains("turned by")) << box->text().toStdString();
  keep("binding-question");
  answer(box, "fit_cage");
  ASSERT_TRUE(wait_until([this] { return document().mode() == Mode::deform; }));
  // A ring lies as well one way up as the other: it is where it was, as a whole.
  EXPECT_LT((bounding_box(document().cage_rest().positions).center() -
             bounding_box(good.positions).center())
                .norm(),
            0.1 * document().diagonal());
}

TEST_F(DailyWork, FollowsByOtherCoordinatesAndKeepsThePose) {
  open_caged();
  bind();
  drag_vertex({60, 20});
  const std::vector<Vec3> posed = cage();
  const std::vector<Vec3> by_mean_value = shown();
  auto* kinds = find<QComboBox>("coordinates");
  const int before = kinds->currentIndex();
  const int other = kinds->findText("Green");
  ASSERT_GE(other, 0);
  kinds->setCurrentIndex(other);
  wait_for_job();
  EXPECT_EQ(document().state().binding->settings().kind().name, "green");
  EXPECT_EQ(cage(), posed);
  EXPECT_GT(greatest_distance(shown(), by_mean_value), 1e-4);
  // Pins are of the cage's vertices alone: told, not made.
  ToolSettings tools = document().tools();
  const Tool tool_before = tools.tool;
  tools.tool = Tool::pull;
  document().set_tools(tools);
  QTest::mouseClick(&view(), Qt::LeftButton, {}, at(shown()[0]));
  EXPECT_TRUE(document().state().pins.empty());
  EXPECT_TRUE(find<QLabel>("notice")->isVisible());
  tools.tool = tool_before;
  document().set_tools(tools);
  ASSERT_TRUE(session().save_project(path("green.cagewright").toStdString()));
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(kinds->currentIndex(), before) << "the panel shows what is bound";
  EXPECT_LT(greatest_distance(shown(), by_mean_value), 1e-9);
  session().open(path("green.cagewright").toStdString());
  wait_for_job();
  EXPECT_EQ(document().state().binding->settings().kind().name, "green");
  EXPECT_EQ(kinds->currentIndex(), other);
  EXPECT_EQ(cage(), posed);
}

TEST_F(DailyWork, ExtrudesInOneStepThatEscapeTakesBackWhole) {
  open_model();
  generate();
  press_at_focus(Qt::Key_3);
  const PolygonMesh before = document().cage();
  QTest::mouseClick(&view(), Qt::LeftButton, {}, at([&] {
    Vec3 sum = Vec3::Zero();
    const CageGraph graph(before);
    const Picker picker(before, graph);
    for (Index f = 0; f < before.face_count(); ++f) { // one that is seen
      sum = Vec3::Zero();
      for (const Index v : before.face(f)) {
        sum += before.positions[v] / static_cast<double>(before.face(f).size());
      }
      if (picker.is_visible(view().camera(), sum)) {
        break;
      }
    }
    return sum;
  }()));
  settle();
  ASSERT_EQ(document().selection().faces.size(), 1U);
  QUndoStack& stack = session().editor().undo_stack();
  const int steps = stack.count();
  press_at_focus(Qt::Key_E);
  ASSERT_TRUE(view().transforming());
  EXPECT_GT(document().cage_rest().face_count(), before.face_count());
  press_at_focus(Qt::Key_Escape);
  EXPECT_EQ(document().cage_rest().face_count(), before.face_count());
  EXPECT_EQ(cage(), before.positions);
  EXPECT_EQ(stack.count(), steps);
  press_at_focus(Qt::Key_E);
  press_at_focus(Qt::Key_Return);
  EXPECT_GT(document().cage_rest().face_count(), before.face_count());
  EXPECT_EQ(stack.count(), steps + 1);
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(document().cage_rest().face_count(), before.face_count());

  // Deleting a face alone would change nothing: it is refused, and says so.
  QString said;
  QObject::connect(&session(), &Session::message, [&](const QString& text) { said = text; });
  press_at_focus(Qt::Key_Delete);
  EXPECT_EQ(document().cage_rest().face_count(), before.face_count());
  EXPECT_EQ(document().selection().mode, SelectionMode::face);
  EXPECT_TRUE(said.contains("closed")) << said.toStdString();
}

TEST_F(DailyWork, AsksBeforeAnotherCageTakesPosesAway) {
  open_model();
  generate();
  bind();
  drag_vertex({40, 0});
  const auto before = document().state().rest;
  const QString asked = answering("Cancel", [this] { trigger("generate_cage"); });
  EXPECT_TRUE(asked.contains("deformation")) << asked.toStdString();
  EXPECT_FALSE(session().jobs().busy());
  EXPECT_EQ(document().state().rest, before);
  answering("Generate", [this] { trigger("generate_cage"); });
  wait_for_job();
  EXPECT_NE(document().state().rest, before);
}

TEST_F(DailyWork, OpensAFileThatIsChosenWhileACageIsMade) {
  ASSERT_TRUE(write_mesh(PolygonMesh(make_icosphere(2)), path("second.obj").toStdString()));
  open_model();
  find<QSpinBox>("vertices")->setValue(200);
  click("generate");
  ASSERT_TRUE(session().jobs().busy());
  with_file(path("second.obj"), [this] { press_at_focus(Qt::Key_O, Qt::ControlModifier); });
  ASSERT_TRUE(wait_until([this] {
    return !session().jobs().busy() && document().model()->path.filename() == "second.obj";
  }));
  EXPECT_FALSE(document().has_cage());
}

TEST_F(DailyWork, RecoversAProjectUnderItsOwnName) {
  open_model();
  generate();
  ASSERT_TRUE(session().save_project(path("work.cagewright").toStdString()));
  drag_vertex({20, 0});
  const std::vector<Vec3> edited = cage();
  ASSERT_TRUE(session().autosave(path("autosave/crashed.cagewright").toStdString()));
  window->close();
  window.reset();
  make_window();
  const QString asked = answering("Recover It", [this] { window->offer_recovery(); });
  EXPECT_TRUE(asked.contains("work.cagewright")) << asked.toStdString();
  wait_for_job();
  EXPECT_EQ(cage(), edited);
  EXPECT_EQ(session().project_path(), path("work.cagewright").toStdString());
  EXPECT_TRUE(window->isWindowModified());
  press_at_focus(Qt::Key_S, Qt::ControlModifier);
  EXPECT_TRUE(wait_until([this] { return !window->isWindowModified(); }));
}

/// F3, words, Enter.
class CommandSearch : public DailyWork {
protected:
  void run(const char* words) {
    press_at_focus(Qt::Key_F3);
    QDialog* search = nullptr;
    ASSERT_TRUE(wait_until([&] {
      search = window->findChild<QDialog*>("command_search");
      return search != nullptr && search->isVisible();
    }));
    auto* text = search->findChild<QLineEdit*>("command_text");
    QTest::keyClicks(text, words);
    QTest::keyClick(text, Qt::Key_Return);
    ASSERT_TRUE(
        wait_until([&] { return window->findChild<QDialog*>("command_search") == nullptr; }));
  }
};

TEST_F(CommandSearch, FindsAnyCommandByAPartOfItsName) {
  open_model();
  run("dark");
  EXPECT_LT(window->palette().color(QPalette::Window).lightness(), 100);
  trigger("dark");
}

TEST_F(CommandSearch, FindsTheSwitchesOfTheLayersToo) {
  open_model();
  const bool before = document().layers().wireframe;
  run("wireframe");
  EXPECT_NE(document().layers().wireframe, before);
  EXPECT_EQ(find<QCheckBox>("wireframe")->isChecked(), !before);
  run("wireframe");
  EXPECT_EQ(document().layers().wireframe, before);
  run("cage vertices layer");
  EXPECT_FALSE(document().layers().cage_vertices);
  run("like metal");
  EXPECT_EQ(document().layers().look, SurfaceLook::metal);
  EXPECT_TRUE(find<QAction>("look_3")->isChecked());
  click("cage_vertices");
  EXPECT_TRUE(find<QAction>("layer_cage_vertices")->isChecked()) << "menu and panel agree";
}

TEST_F(DailyWork, OffersWhatCanBeDoneUnderThePointer) {
  open_model();
  generate();
  const Index v = front_vertex();
  const QPoint place = at(document().shown_cage_positions()[v]);
  QTest::mousePress(&view(), Qt::RightButton, {}, place);
  QContextMenuEvent event(QContextMenuEvent::Mouse, place, view().mapToGlobal(place));
  QCoreApplication::sendEvent(&view(), &event);
  QTest::mouseRelease(&view(), Qt::RightButton, {}, place);
  QMenu* menu = nullptr;
  ASSERT_TRUE(wait_until([&] {
    menu = window->findChild<QMenu*>("view_menu");
    return menu != nullptr && menu->isVisible();
  }));
  EXPECT_EQ(document().selection().vertices, std::vector<Index>{v});
  EXPECT_TRUE(menu->actions().contains(find<QAction>("bind_model")));
  EXPECT_FALSE(menu->actions().contains(find<QAction>("keyframe")));
  menu->close();
  // The right button ends a drag, and no menu comes up.
  press_at_focus(Qt::Key_G);
  QTest::mousePress(&view(), Qt::RightButton, {}, place);
  QCoreApplication::sendEvent(&view(), &event);
  QTest::mouseRelease(&view(), Qt::RightButton, {}, place);
  EXPECT_FALSE(view().transforming());
  EXPECT_EQ(QApplication::activePopupWidget(), nullptr);
}

TEST_F(DailyWork, GoesBackAlongTheHistory) {
  open_model();
  generate();
  const std::vector<Vec3> made = cage();
  press_at_focus(Qt::Key_1);
  press_at_focus(Qt::Key_A);
  press_at_focus(Qt::Key_A, Qt::AltModifier);
  press_at_focus(Qt::Key_A);
  press_at_focus(Qt::Key_A, Qt::AltModifier);
  drag_vertex({30, 0});
  auto* list = find<QListWidget>("history");
  ASSERT_EQ(list->count(), 4) << "opened, generated, selected, moved";
  EXPECT_TRUE(list->item(2)->text().startsWith("Select ("));
  EXPECT_EQ(list->currentRow(), 3);
  find<QDockWidget>("dock_history")->raise();
  settle();
  QTest::mouseClick(list->viewport(), Qt::LeftButton, {},
                    list->visualItemRect(list->item(1)).center());
  EXPECT_EQ(cage(), made);
  EXPECT_EQ(list->currentRow(), 1);
  keep("history");
}

TEST_F(DailyWork, ShowsTheViewAloneAndWhatWasRefused) {
  open_model();
  generate();
  press_at_focus(Qt::Key_Space, Qt::ControlModifier);
  EXPECT_FALSE(find<QDockWidget>("dock_figures")->isVisible());
  keep("full-view");
  press_at_focus(Qt::Key_Space, Qt::ControlModifier);
  EXPECT_TRUE(find<QDockWidget>("dock_figures")->isVisible());
  const Layers before = document().layers();
  press_at_focus(Qt::Key_Z);
  EXPECT_TRUE(document().layers().wireframe);
  press_at_focus(Qt::Key_Z);
  EXPECT_FALSE(document().layers().smooth_normals);
  press_at_focus(Qt::Key_Z);
  EXPECT_EQ(document().layers(), before);
  press_at_focus(Qt::Key_Delete); // nothing is selected
  EXPECT_TRUE(find<QLabel>("notice")->isVisible());
  keep("refused");
}

} // namespace
} // namespace cagewright::app
