#include "window_fixture.h"

#include "core/random.h"

#include <QComboBox>
#include <QDockWidget>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QProgressBar>
#include <QRegularExpression>
#include <QSlider>
#include <QToolButton>
#include <QTreeWidget>
#include <QWheelEvent>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>

namespace cagewright::app {
namespace {

TEST_F(Window, LeadsFromAnEmptyWindowToAnExportedModel) {
  auto* guide = find<QLabel>("guide_text");
  EXPECT_TRUE(guide->text().contains("Open a model"));
  EXPECT_TRUE(find<QWidget>("welcome")->isVisible());
  EXPECT_FALSE(find<QPushButton>("generate")->isEnabled());
  keep("empty");

  open_model();
  EXPECT_FALSE(find<QWidget>("welcome")->isVisible());
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
  press(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(cage(), refined);

  bind();
  const std::vector<Vec3> rest = shown();
  drag_gizmo(80);
  EXPECT_GT(greatest_distance(shown(), rest), 1e-3) << "the model follows";
  EXPECT_TRUE(guide->text().contains("Export"));
  const std::vector<Vec3> posed = shown();
  press(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_LT(greatest_distance(shown(), rest), 1e-9);
  press(Qt::Key_Y, Qt::ControlModifier);
  EXPECT_LT(greatest_distance(shown(), posed), 1e-9);
  keep("posed");

  press(Qt::Key_K, Qt::ControlModifier);
  EXPECT_EQ(document().state().poses.size(), 1U);
  with_file(path("out.obj"), [this] { click("guide_button"); });
  wait_for_job();
  const auto written = read_mesh(path("out.obj").toStdString());
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_LT(greatest_distance(written->positions, posed), 1e-5);

  with_file(path("work.cagewright"), [this] { press(Qt::Key_S, Qt::ControlModifier); });
  EXPECT_FALSE(window->isWindowModified());
  const std::vector<Vec3> pose = cage();
  window->close();
  window.reset();
  make_window();
  with_file(path("work.cagewright"), [this] { press(Qt::Key_O, Qt::ControlModifier); });
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
  const int deepest = depth->value();
  press_in_view(Qt::Key_BracketLeft);
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
  show_time_line();
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

/// Between two colors, as the guidelines for web pages have it: 4.5 is enough for text.
double contrast(const QColor& a, const QColor& b) {
  const auto luminance = [](const QColor& color) {
    const auto linear = [](double c) {
      return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) +
           0.0722 * linear(color.blueF());
  };
  const auto [less, more] = std::minmax({luminance(a), luminance(b)});
  return (more + 0.05) / (less + 0.05);
}

TEST_F(Window, IsReadableInTheDark) {
  open_model();
  generate();
  const auto expect_readable_figures = [this] {
    static const QRegularExpression colored("color:(#[0-9a-f]{6})");
    int words = 0;
    for (const QLabel* label : find<QDockWidget>("dock_figures")->findChildren<QLabel*>()) {
      if (const auto found = colored.match(label->text()); found.hasMatch()) {
        ++words;
        EXPECT_GE(contrast(QColor(found.captured(1)), window->palette().color(QPalette::Window)),
                  4.5)
            << label->text().toStdString();
      }
    }
    EXPECT_GE(words, 4);
  };
  ASSERT_TRUE(wait_until([this] { return !session().checker().busy(); }));
  expect_readable_figures();
  trigger("dark");
  keep("dark");
  expect_readable_figures();
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
      Qt::Key_Tab,    Qt::Key_H,      Qt::Key_Slash,       Qt::Key_W,
      Qt::Key_Q,      Qt::Key_F3,     Qt::Key_Backslash,   Qt::Key_Y};
  const std::vector<Qt::KeyboardModifiers> modifiers = {
      Qt::NoModifier, Qt::NoModifier, Qt::ShiftModifier, Qt::ControlModifier, Qt::AltModifier};
  const std::vector<Qt::MouseButton> mouse_buttons = {
      Qt::LeftButton, Qt::LeftButton, Qt::LeftButton, Qt::MiddleButton, Qt::RightButton};
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
    switch (pick(16)) {
    case 0:
    case 1:
      drag(a, b, modifiers[pick(modifiers.size())], mouse_buttons[pick(mouse_buttons.size())]);
      break;
    case 8: {
      QWheelEvent wheel(a, view().mapToGlobal(a), {}, QPoint(0, pick(2) == 0 ? 120 : -120),
                        Qt::NoButton, modifiers[pick(modifiers.size())], Qt::NoScrollPhase, false);
      QCoreApplication::sendEvent(&view(), &wheel);
      break;
    }
    case 9: {
      const QList<QSlider*> sliders = window->findChildren<QSlider*>();
      QSlider* slider =
          sliders[static_cast<qsizetype>(pick(static_cast<std::size_t>(sliders.size())))];
      if (slider->isVisible() && slider->isEnabled()) {
        QTest::mouseClick(slider, Qt::LeftButton, {},
                          QPoint(static_cast<int>(pick(static_cast<std::size_t>(slider->width()))),
                                 slider->height() / 2));
      }
      break;
    }
    case 10: {
      const std::array<const char*, 4> names = {"coordinates", "mix", "beside", "look"};
      auto* box = find<QComboBox>(names[pick(names.size())]);
      box->setCurrentIndex(static_cast<int>(pick(static_cast<std::size_t>(box->count()))));
      break;
    }
    case 12: { // a stroke of a brush, or a lasso round a part of the model
      const std::array<const char*, 4> tools = {"tool_mix", "tool_paint", "tool_region",
                                                "tool_lasso"};
      trigger(tools[pick(tools.size())]);
      drag(a, b, modifiers[pick(modifiers.size())]);
      break;
    }
    case 13: { // what the cage is for
      const std::size_t faces = document().model()->mesh.face_count();
      std::vector<Index> some(1 + pick(faces));
      std::iota(some.begin(), some.end(), Index{0});
      pick(2) == 0 ? session().choose_region("some", some) : session().choose_whole_model();
      break;
    }
    case 14: { // any command, by a few letters
      press(Qt::Key_F3);
      if (auto* search = window->findChild<QDialog*>("command_search")) {
        for (std::size_t n = pick(4); n > 0; --n) {
          QTest::keyClick(search->findChild<QLineEdit*>(),
                          static_cast<Qt::Key>(Qt::Key_A + static_cast<int>(pick(26))));
        }
        search->close(); // it might run what asks for a file
      }
      break;
    }
    case 11:
      QTest::mouseDClick(&view(), Qt::LeftButton, {}, a);
      break;
    case 2:
      QTest::mouseClick(&view(), Qt::LeftButton, pick(2) == 0 ? Qt::NoModifier : Qt::ShiftModifier,
                        a);
      break;
    case 3:
    case 4:
      QTest::keyClick(&view(), keys[pick(keys.size())],
                      pick(6) == 0 ? Qt::AltModifier : Qt::NoModifier);
      break;
    case 5:
      press(pick(3) == 0 ? Qt::Key_Y : Qt::Key_Z, Qt::ControlModifier);
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
  press_in_view(Qt::Key_Escape);
  QUndoStack& stack = session().editor().undo_stack();
  while (stack.canUndo()) {
    stack.undo();
  }
  settle();
}

} // namespace
} // namespace cagewright::app
