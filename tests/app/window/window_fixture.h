/// \file
/// The whole window on a display, and what a person does with it: for tests.
#pragma once

#include "app/main_window.h"

#include "app/view/viewport.h"
#include "mesh/shapes.h"
#include "mouse.h"
#include "waiting.h"
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>

#include <QApplication>
#include <QCheckBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QFileDialog>
#include <QLineEdit>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTest>
#include <QTimer>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace cagewright::app {

using test::wait_until;

/// A bumpy torus: a model with a handle, quick to make a cage for.
inline PolygonMesh model() {
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

  /// Shortcuts are those of the active window. Which one that is the display says in its own time,
  /// and may say so late, when another has just been closed: ask before every key, see press().
  void activate() {
    ASSERT_TRUE(wait_until([this] {
      window->activateWindow();
      return window->isActiveWindow();
    }));
  }

  /// Presses a key in the window; its shortcuts go before what the view does with the key.
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    activate();
    QTest::keyClick(window.get(), key, modifiers);
  }
  void press_in_view(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    activate();
    view().setFocus();
    QTest::keyClick(&view(), key, modifiers);
  }
  /// A key pressed wherever the focus is, as a person does; then all is drawn.
  void press_at_focus(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) {
    activate();
    QWidget* focus = window->focusWidget();
    QTest::keyClick(focus != nullptr ? focus : window.get(), key, modifiers);
    settle();
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
  /// Until the display has said all, the model is where its cage wants it, and all is drawn.
  void settle() {
    QGuiApplication::sync();
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
      if (dialog == nullptr) {
        return;
      }
      typed = true;
      // As a whole: what completes names letter by letter would answer Return itself. Again, until
      // the dialog is gone: its button may not be ready yet.
      dialog->findChild<QLineEdit*>("fileNameEdit")->setText(file);
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->buttons().first(), Qt::LeftButton);
    });
    timer.start(30);
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
    with_file(path("model.obj"), [this] { press(Qt::Key_O, Qt::ControlModifier); });
    wait_for_job();
    ASSERT_TRUE(document().has_model());
  }
  void generate() {
    find<QSpinBox>("vertices")->setValue(30);
    click("generate");
    wait_for_job();
    ASSERT_TRUE(document().has_cage());
  }
  /// The model in a cage that is there already: quicker than to generate one.
  void open_caged() {
    ASSERT_TRUE(write_mesh(PolygonMesh(make_torus(0.62, 16, 8)), path("cage.obj").toStdString()));
    session().open(path("model.obj").toStdString(), path("cage.obj").toStdString());
    wait_for_job();
    ASSERT_TRUE(document().has_cage());
  }
  void take_tool(Tool tool) {
    ToolSettings tools = document().tools();
    tools.tool = tool;
    document().set_tools(tools);
    settle();
  }
  /// The time line is folded until there is something on it.
  void show_time_line() {
    find<QDockWidget>("dock_time_line")->show();
    find<QDockWidget>("dock_time_line")->raise();
    settle();
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
  void drag(QPoint from, QPoint to, Qt::KeyboardModifiers modifiers = {},
            Qt::MouseButton button = Qt::LeftButton) {
    test::drag_mouse(view(), from, to, modifiers, button);
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

inline double greatest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double greatest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    greatest = std::max(greatest, (a[i] - b[i]).norm());
  }
  return greatest;
}

} // namespace cagewright::app
