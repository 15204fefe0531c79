#include "app/main_window.h"

#include "app/view/viewport.h"
#include "core/random.h"
#include "mesh/shapes.h"
#include "waiting.h"
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QSlider>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>
#include <QToolButton>
#include <QTreeWidget>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>

namespace cagewright::app {
namespace {

using test::wait_until;

/// A bumpy torus: a model with a handle, quick to make a cage for.
PolygonMesh model() {
  TriangleMesh mesh = make_torus(0.35, 48, 24);
  for (Vec3& p : mesh.positions) {
    p *= 1 + 0.1 * std::sin(5 * p.x()) * std::cos(4 * p.y());
  }
  return PolygonMesh(mesh);
}

class Window : public testing::Test {
protected:
  void SetUp() override {
    QSettings().clear();
    ASSERT_TRUE(write_mesh(model(), path("model.obj").toStdString()));
    make_window();
  }

  void TearDown() override { window.reset(); }

  void make_window() {
    QSettings().setValue("ask_before_closing", false);
    window = std::make_unique<MainWindow>(QDir(path("autosave")));
    window->resize(1280, 800);
    window->show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window.get()));
    activate();
    view().setFocus();
    settle();
  }

  /// Shortcuts are those of the active window, and the last one that was may still be going.
  void activate() {
    ASSERT_TRUE(wait_until([this] {
      window->activateWindow();
      return window->isActiveWindow();
    }));
  }

  QString path(const char* name) const { return folder.filePath(name); }
  Session& session() { return window->session(); }
  Document& document() { return session().document(); }
  Viewport& view() { return window->viewport(); }

  template <class W> W* find(const char* name) {
    W* widget = window->findChild<W*>(name);
    EXPECT_NE(widget, nullptr) << name;
    return widget;
  }
  void click(const char* button) {
    auto* widget = find<QAbstractButton>(button);
    ASSERT_TRUE(widget->isEnabled()) << button;
    ASSERT_TRUE(widget->isVisible()) << button;
    // A check box only minds clicks on its box and its text.
    const bool is_check_box = qobject_cast<QCheckBox*>(widget) != nullptr;
    QTest::mouseClick(widget, Qt::LeftButton, {},
                      is_check_box ? QPoint(8, widget->height() / 2) : QPoint());
  }
  void trigger(const char* action) { find<QAction>(action)->trigger(); }

  void wait_for_job() {
    ASSERT_TRUE(wait_until([this] { return !session().jobs().busy(); }));
    settle();
  }
  void settle() {
    QTest::qWait(20);
    session().deform_loop().finish();
    view().grabFramebuffer();
  }
  /// Keeps a picture of the window.
  void keep(const char* name) {
    ASSERT_TRUE(wait_until([this] { return !session().checker().busy(); }));
    settle();
    QPixmap picture = window->grab();
    picture.save(QString("%1/window-%2.png").arg(CAGEWRIGHT_SCREENSHOTS, name));
    EXPECT_EQ(picture.size(), window->size() * window->devicePixelRatio());
  }

  /// Does something that asks for a file, and types the file's name.
  void with_file(const QString& file, const std::function<void()>& act) {
    bool typed = false;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
      auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
      if (dialog == nullptr || typed) {
        return;
      }
      typed = true;
      // As a whole: what completes names letter by letter would answer Return itself.
      dialog->findChild<QLineEdit*>("fileNameEdit")->setText(file);
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->buttons().first(), Qt::LeftButton);
    });
    timer.start(30);
    activate();
    act();
    EXPECT_TRUE(typed) << "no file was asked for";
  }

  /// Drags a file onto the window from elsewhere.
  void drop(const QString& file) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(file)});
    QDragEnterEvent enter({300, 300}, Qt::CopyAction, &data, Qt::LeftButton, {});
    QCoreApplication::sendEvent(window.get(), &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent dropped({300, 300}, Qt::CopyAction, &data, Qt::LeftButton, {});
    QCoreApplication::sendEvent(window.get(), &dropped);
  }

  void open_model() {
    with_file(path("model.obj"),
              [this] { QTest::keyClick(window.get(), Qt::Key_O, Qt::ControlModifier); });
    wait_for_job();
    ASSERT_TRUE(document().has_model());
  }
  void generate() {
    find<QSpinBox>("vertices")->setValue(30);
    click("generate");
    wait_for_job();
    ASSERT_TRUE(document().has_cage());
  }
  void bind() {
    click("bind");
    wait_for_job();
    ASSERT_EQ(document().mode(), Mode::deform);
  }

  [[nodiscard]] QPoint at(const Vec3& p) {
    const Pixel pixel = view().camera().project(p)->pixel;
    return {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
  }
  /// The vertex nearest to the viewer.
  Index front_vertex() {
    const std::span<const Vec3> p = document().shown_cage_positions();
    const Vec3 backward = view().camera().axes().row(2);
    return static_cast<Index>(std::max_element(p.begin(), p.end(),
                                               [&](const Vec3& a, const Vec3& b) {
                                                 return a.dot(backward) < b.dot(backward);
                                               }) -
                              p.begin());
  }
  void drag(QPoint from, QPoint to) {
    QTest::mouseMove(&view(), from);
    QTest::mousePress(&view(), Qt::LeftButton, {}, from);
    for (int i = 1; i <= 6; ++i) {
      const QPoint p = from + (to - from) * i / 6;
      QMouseEvent move(QEvent::MouseMove, p, view().mapToGlobal(p), Qt::NoButton, Qt::LeftButton,
                       {});
      QCoreApplication::sendEvent(&view(), &move);
    }
    QTest::mouseRelease(&view(), Qt::LeftButton, {}, to);
  }
  /// Selects the vertex by a click and drags the gizmo's arrow along x.
  void drag_gizmo(int pixels) {
    const Index v = front_vertex();
    QTest::mouseClick(&view(), Qt::LeftButton, {}, at(document().shown_cage_positions()[v]));
    settle();
    ASSERT_EQ(document().selection().vertices, std::vector<Index>{v});
    const std::optional<GizmoFrame> gizmo = view().gizmo();
    ASSERT_TRUE(gizmo);
    const double pixel = view().camera().pixel_size(gizmo->origin);
    drag(at(gizmo->origin + 50 * pixel * Vec3::UnitX()),
         at(gizmo->origin + (50 + pixels) * pixel * Vec3::UnitX()));
    settle();
  }
  std::vector<Vec3> cage() {
    return {document().cage_positions().begin(), document().cage_positions().end()};
  }
  std::vector<Vec3> shown() {
    settle();
    return {document().model_positions().begin(), document().model_positions().end()};
  }

  QTemporaryDir folder;
  std::unique_ptr<MainWindow> window;
};

double greatest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double greatest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    greatest = std::max(greatest, (a[i] - b[i]).norm());
  }
  return greatest;
}

TEST_F(Window, LeadsFromAnEmptyWindowToAnExportedModel) {
  auto* guide = find<QLabel>("guide_text");
  EXPECT_TRUE(guide->text().contains("Open a model"));
  EXPECT_TRUE(find<QLabel>("welcome")->isVisible());
  EXPECT_FALSE(find<QPushButton>("generate")->isEnabled());
  keep("empty");

  open_model();
  EXPECT_FALSE(find<QLabel>("welcome")->isVisible());
  EXPECT_TRUE(guide->text().contains("Make a cage"));
  generate();
  ASSERT_TRUE(wait_until([this] { return !session().checker().busy(); }));
  EXPECT_TRUE(find<QLabel>("verdict")->text().contains("Valid"));
  EXPECT_EQ(find<QLabel>("vertices")->text().toULong(), cage().size());
  EXPECT_TRUE(guide->text().contains("bind"));
  keep("cage");

  const std::vector<Vec3> refined = cage();
  drag_gizmo(30);
  EXPECT_GT(greatest_distance(cage(), refined), 0) << "the cage itself is refined";
  QTest::keyClick(window.get(), Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(cage(), refined);

  bind();
  const std::vector<Vec3> rest = shown();
  drag_gizmo(80);
  EXPECT_GT(greatest_distance(shown(), rest), 1e-3) << "the model follows";
  EXPECT_TRUE(guide->text().contains("Export"));
  const std::vector<Vec3> posed = shown();
  QTest::keyClick(window.get(), Qt::Key_Z, Qt::ControlModifier);
  EXPECT_LT(greatest_distance(shown(), rest), 1e-9);
  QTest::keyClick(window.get(), Qt::Key_Y, Qt::ControlModifier);
  EXPECT_LT(greatest_distance(shown(), posed), 1e-9);
  keep("posed");

  QTest::keyClick(window.get(), Qt::Key_K, Qt::ControlModifier);
  EXPECT_EQ(document().state().poses.size(), 1U);
  with_file(path("out.obj"), [this] { click("guide_button"); });
  wait_for_job();
  const auto written = read_mesh(path("out.obj").toStdString());
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_LT(greatest_distance(written->positions, posed), 1e-5);

  with_file(path("work.cagewright"),
            [this] { QTest::keyClick(window.get(), Qt::Key_S, Qt::ControlModifier); });
  EXPECT_FALSE(window->isWindowModified());
  const std::vector<Vec3> pose = cage();
  window->close();
  window.reset();
  make_window();
  with_file(path("work.cagewright"),
            [this] { QTest::keyClick(window.get(), Qt::Key_O, Qt::ControlModifier); });
  wait_for_job();
  EXPECT_EQ(document().mode(), Mode::deform);
  EXPECT_EQ(cage(), pose);
  EXPECT_LT(greatest_distance(shown(), posed), 1e-9);
  EXPECT_EQ(find<QListWidget>("poses")->count(), 1);
}

TEST_F(Window, CancelsInTheMiddle) {
  open_model();
  generate();
  const auto before = document().state().rest;
  find<QSpinBox>("vertices")->setValue(200);
  click("generate");
  ASSERT_TRUE(wait_until([this] { return find<QProgressBar>("progress")->isVisible(); }));
  EXPECT_FALSE(find<QPushButton>("generate")->isEnabled());
  click("cancel");
  wait_for_job();
  EXPECT_EQ(document().state().rest, before) << "the old cage stays";
  EXPECT_FALSE(find<QProgressBar>("progress")->isVisible());
  EXPECT_TRUE(find<QPushButton>("generate")->isEnabled());
}

TEST_F(Window, SaysWhatIsWrongWithAFileThatIsDropped) {
  for (const char* name : {"missing.obj", "broken.ply", "empty.stl", "broken.cagewright"}) {
    if (QString(name) != "missing.obj") {
      std::ofstream(path(name).toStdString())
          << (QString(name) == "empty.stl" ? "" : "{ply nonsense");
    }
    drop(path(name));
    QMessageBox* box = nullptr;
    ASSERT_TRUE(wait_until([&] {
      box = window->findChild<QMessageBox*>("error");
      return box != nullptr;
    })) << name;
    EXPECT_TRUE(box->text().contains(name)) << box->text().toStdString();
    QTest::keyClick(box, Qt::Key_Return);
    ASSERT_TRUE(wait_until([&] { return window->findChild<QMessageBox*>("error") == nullptr; }));
    EXPECT_FALSE(document().has_model());
  }
}

TEST_F(Window, OpensAFileThatIsDropped) {
  drop(path("model.obj"));
  ASSERT_TRUE(wait_until([this] { return document().has_model(); }));
}

TEST_F(Window, ShowsHowTheModelWasSplit) {
  open_model();
  find<QSpinBox>("depth")->setValue(3);
  click("boxes");
  wait_for_job();
  ASSERT_TRUE(document().stages());
  auto* depth = find<QSlider>("shown_depth");
  EXPECT_GT(depth->maximum(), 0);
  view().setFocus();
  const int deepest = depth->value();
  QTest::keyClick(&view(), Qt::Key_BracketLeft);
  EXPECT_EQ(document().layers().depth, deepest - 1);
  find<QDockWidget>("dock_sections")->raise();
  auto* tree = window->findChild<QTreeWidget*>("boxes_tree");
  tree->setCurrentItem(tree->topLevelItem(0));
  EXPECT_EQ(document().layers().selected_box, 0);
  keep("boxes");
}

TEST_F(Window, PlaysKeyframes) {
  open_model();
  generate();
  bind();
  const std::vector<Vec3> rest = shown();
  click("set_keyframe"); // at the first frame, at rest
  drag_gizmo(70);
  const std::vector<Vec3> posed = cage();
  view().setFocus();
  session().editor().set_keyframe(20);
  ASSERT_EQ(document().state().time_line.keys.size(), 2U);
  find<QSpinBox>("frame")->setValue(10);
  EXPECT_GT(greatest_distance(shown(), rest), 1e-4);
  keep("time-line");
  click("play");
  ASSERT_TRUE(wait_until([this] { return document().time() && *document().time() > 12; }));
  click("play");
  EXPECT_EQ(cage(), posed) << "playing changes nothing";
}

TEST_F(Window, HasEveryActionInAMenuAndTellsWhatItDoes) {
  int actions = 0;
  for (QAction* action : window->findChildren<QAction*>()) {
    if (action->isSeparator() || action->menu() != nullptr || action->objectName().isEmpty() ||
        action->objectName() == "undo" || action->objectName() == "redo" ||
        action->objectName().startsWith("_q_") || action->objectName().startsWith("qt_")) {
      continue;
    }
    ++actions;
    EXPECT_FALSE(action->toolTip().isEmpty()) << action->objectName().toStdString();
    EXPECT_FALSE(action->associatedObjects().isEmpty()) << action->objectName().toStdString();
  }
  EXPECT_GT(actions, 50);
  std::map<QString, QString> taken;
  for (QAction* action : window->findChildren<QAction*>()) {
    for (const QKeySequence& keys : action->shortcuts()) {
      const auto [place, is_new] = taken.try_emplace(keys.toString(), action->objectName());
      EXPECT_TRUE(is_new) << keys.toString().toStdString() << " is that of "
                          << place->second.toStdString() << ", too";
    }
  }
}

TEST_F(Window, RemembersWhereItsPanelsWere) {
  auto* figures = find<QDockWidget>("dock_figures");
  figures->hide();
  find<QSpinBox>("vertices")->setValue(77);
  window->close();
  window.reset();
  make_window();
  EXPECT_FALSE(find<QDockWidget>("dock_figures")->isVisible());
  EXPECT_EQ(find<QSpinBox>("vertices")->value(), 77);
  trigger("reset_panels");
  EXPECT_TRUE(find<QDockWidget>("dock_figures")->isVisible());
}

TEST_F(Window, IsReadableInTheDark) {
  open_model();
  generate();
  trigger("dark");
  keep("dark");
  EXPECT_LT(window->palette().color(QPalette::Window).lightness(), 100);
  EXPECT_GT(window->palette().color(QPalette::WindowText).lightness(), 180);
  trigger("dark");
}

TEST_F(Window, SurvivesFiveHundredRandomActions) {
  open_model();
  generate();
  Random random(20120101);
  const auto pick = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(n) * 0.999999);
  };
  const std::vector<Qt::Key> keys = {
      Qt::Key_A,      Qt::Key_1,      Qt::Key_2,           Qt::Key_3,
      Qt::Key_G,      Qt::Key_R,      Qt::Key_S,           Qt::Key_X,
      Qt::Key_Y,      Qt::Key_Z,      Qt::Key_5,           Qt::Key_Minus,
      Qt::Key_Return, Qt::Key_Escape, Qt::Key_E,           Qt::Key_F,
      Qt::Key_Home,   Qt::Key_K,      Qt::Key_Space,       Qt::Key_Delete,
      Qt::Key_Left,   Qt::Key_C,      Qt::Key_BracketLeft, Qt::Key_BracketRight,
      Qt::Key_O,      Qt::Key_B,      Qt::Key_L,           Qt::Key_M,
      Qt::Key_Tab};
  // Not those that open dialogs.
  QList<QAction*> actions;
  for (QAction* action : window->findChildren<QAction*>()) {
    if (!action->objectName().isEmpty() && !action->text().endsWith("...") &&
        !QStringList({"quit", "save", "first_steps", "keys", "about"})
             .contains(action->objectName())) {
      actions.append(action);
    }
  }
  // Whatever asks a question is answered with no, and menus that open are closed.
  QTimer refuse;
  QObject::connect(&refuse, &QTimer::timeout, [] {
    if (QWidget* menu = QApplication::activePopupWidget()) {
      menu->close();
    }
    if (auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget())) {
      dialog->reject();
    }
  });
  refuse.start(20);
  for (int i = 0; i < 500; ++i) {
    const QPoint a(static_cast<int>(pick(static_cast<std::size_t>(view().width()))),
                   static_cast<int>(pick(static_cast<std::size_t>(view().height()))));
    const QPoint b(static_cast<int>(pick(static_cast<std::size_t>(view().width()))),
                   static_cast<int>(pick(static_cast<std::size_t>(view().height()))));
    switch (pick(8)) {
    case 0:
    case 1:
      drag(a, b);
      break;
    case 2:
      QTest::mouseClick(&view(), Qt::LeftButton, pick(2) == 0 ? Qt::NoModifier : Qt::ShiftModifier,
                        a);
      break;
    case 3:
    case 4:
      QTest::keyClick(&view(), keys[pick(keys.size())]);
      break;
    case 5:
      QTest::keyClick(window.get(), pick(3) == 0 ? Qt::Key_Y : Qt::Key_Z, Qt::ControlModifier);
      break;
    case 6:
      actions[static_cast<qsizetype>(pick(static_cast<std::size_t>(actions.size())))]->trigger();
      break;
    default: {
      const QList<QAbstractButton*> buttons = window->findChildren<QAbstractButton*>();
      QAbstractButton* button =
          buttons[static_cast<qsizetype>(pick(static_cast<std::size_t>(buttons.size())))];
      if (button->isVisible() && button->isEnabled() && !button->text().endsWith("...") &&
          button->objectName() != "qt_menubar_ext_button") {
        QTest::mouseClick(button, Qt::LeftButton);
      }
    }
    }
    QCoreApplication::processEvents();
    if (auto* box = window->findChild<QMessageBox*>()) {
      box->close();
    }
    for (const Vec3& p : document().cage_positions()) {
      ASSERT_TRUE(p.allFinite()) << "after action " << i;
    }
  }
  wait_for_job();
  QTest::keyClick(&view(), Qt::Key_Escape);
  QUndoStack& stack = session().editor().undo_stack();
  while (stack.canUndo()) {
    stack.undo();
  }
  settle();
}

} // namespace
} // namespace cagewright::app
