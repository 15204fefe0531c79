// What a person stumbles over on the first day, by mouse and by keys.
#include "window_fixture.h"

#include <QDockWidget>
#include <QLabel>
#include <QListWidget>
#include <QScrollArea>
#include <QTabBar>
#include <QToolBar>
#include <QToolButton>

namespace cagewright::app {
namespace {

class FirstDay : public Window {
protected:
  bool says_something() { return find<QLabel>("notice")->isVisible(); }
  /// A place of the view where the model is seen.
  QPoint on_model() {
    const std::span<const Vec3> p = document().model_positions();
    const Vec3 backward = view().camera().axes().row(2);
    return at(*std::ranges::max_element(p, {}, [&](const Vec3& v) { return v.dot(backward); }));
  }
  int steps() { return session().editor().undo_stack().count(); }
};

TEST_F(FirstDay, ForgetsARefusalAsSoonAsItIsPast) {
  open_caged();
  take_tool(Tool::pull);
  QTest::mouseClick(&view(), Qt::LeftButton, {}, on_model());
  EXPECT_TRUE(says_something()) << "first it is bound";
  bind();
  EXPECT_FALSE(says_something());
  take_tool(Tool::translate);
  press_at_focus(Qt::Key_G); // nothing is selected
  EXPECT_FALSE(view().transforming());
  EXPECT_TRUE(says_something());
  press_at_focus(Qt::Key_A);
  EXPECT_FALSE(says_something());
  // What a step says of itself stays to be read.
  press_at_focus(Qt::Key_G);
  ASSERT_TRUE(view().transforming());
  test::move_mouse(view(), QPoint(200, 200), Qt::NoButton);
  test::move_mouse(view(), QPoint(300, 220), Qt::NoButton);
  press_at_focus(Qt::Key_Return);
  session().refine();
  EXPECT_TRUE(says_something());
  EXPECT_TRUE(find<QLabel>("notice")->text().contains("Last pose"));
}

TEST_F(FirstDay, TabSwitchesAfterAClickInAPanel) {
  open_caged();
  bind();
  auto* layers = find<QDockWidget>("dock_layers")->findChild<QScrollArea*>();
  ASSERT_NE(layers, nullptr);
  find<QDockWidget>("dock_layers")->raise();
  settle();
  QTest::mouseClick(layers->viewport(), Qt::LeftButton, {},
                    QPoint(layers->viewport()->width() - 4, 4));
  ASSERT_NE(window->focusWidget(), &view());
  press_at_focus(Qt::Key_Tab);
  EXPECT_EQ(document().mode(), Mode::refine);
  // Who walks by Tab goes on walking.
  bind();
  find<QDockWidget>("dock_poses")->raise();
  settle();
  find<QListWidget>("poses")->setFocus(Qt::TabFocusReason);
  press_at_focus(Qt::Key_Tab);
  EXPECT_EQ(document().mode(), Mode::deform);
  EXPECT_NE(window->focusWidget(), find<QListWidget>("poses"));
}

TEST_F(FirstDay, BeginsAStrokeBesideTheModel) {
  open_caged();
  const Selection before = document().selection();
  take_tool(Tool::paint);
  const int count = steps();
  drag(QPoint(3, 3), QPoint(30, 3));
  EXPECT_EQ(steps(), count) << "it has met nothing";
  EXPECT_FALSE(document().state().density);
  drag(QPoint(3, 3), on_model());
  EXPECT_EQ(steps(), count + 1);
  EXPECT_TRUE(document().state().density);
  EXPECT_EQ(document().selection(), before);
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_FALSE(document().state().density);
}

TEST_F(FirstDay, SaysThatLoopsNeedQuads) {
  open_model();
  generate();
  press_at_focus(Qt::Key_2);
  const PolygonMesh before = document().cage();
  const Index v = front_vertex();
  const std::span<const Vec3> p = document().shown_cage_positions();
  Index other = v;
  for (std::size_t f = 0; f < before.face_count(); ++f) {
    const auto corners = before.face(f);
    const auto here = std::ranges::find(corners, v);
    if (here != corners.end()) {
      other = here + 1 == corners.end() ? corners.front() : *(here + 1);
    }
  }
  test::move_mouse(view(), (at(p[v]) + at(p[other])) / 2, Qt::NoButton);
  press_at_focus(Qt::Key_R, Qt::ControlModifier);
  ASSERT_TRUE(view().cutting_loops());
  QTest::mouseClick(&view(), Qt::LeftButton, {}, (at(p[v]) + at(p[other])) / 2);
  EXPECT_TRUE(says_something());
  EXPECT_EQ(document().cage().positions.size(), before.positions.size());
  press_at_focus(Qt::Key_Escape);
  EXPECT_FALSE(view().cutting_loops());
}

TEST_F(FirstDay, ThePointerTellsWhatAPressDoes) {
  open_caged();
  const QPoint beside(4, 4);
  const auto shape = [this] { return view().cursor().shape(); };
  test::move_mouse(view(), beside, Qt::NoButton);
  EXPECT_EQ(shape(), Qt::ArrowCursor);
  take_tool(Tool::select_box);
  EXPECT_EQ(shape(), Qt::CrossCursor);
  take_tool(Tool::translate);
  EXPECT_EQ(shape(), Qt::ArrowCursor);
  press_at_focus(Qt::Key_A);
  press_at_focus(Qt::Key_G);
  EXPECT_EQ(shape(), Qt::SizeAllCursor);
  press_at_focus(Qt::Key_Escape);
  EXPECT_EQ(shape(), Qt::ArrowCursor);
  QTest::mousePress(&view(), Qt::MiddleButton, {}, beside);
  EXPECT_EQ(shape(), Qt::ClosedHandCursor);
  QTest::mouseRelease(&view(), Qt::MiddleButton, {}, beside);
  EXPECT_EQ(shape(), Qt::ArrowCursor);
}

TEST_F(FirstDay, FindsACommandByItsMenuAndByWhatItDoes) {
  open_caged();
  const auto first_found = [this](const char* words) {
    press_at_focus(Qt::Key_F3);
    QDialog* search = nullptr;
    EXPECT_TRUE(wait_until([&] {
      search = window->findChild<QDialog*>("command_search");
      return search != nullptr && search->isVisible();
    }));
    QTest::keyClicks(search->findChild<QLineEdit*>("command_text"), words);
    const auto* list = search->findChild<QListWidget*>("command_list");
    const QString found = list->count() > 0 ? list->item(0)->text() : QString();
    search->close();
    EXPECT_TRUE(
        wait_until([&] { return window->findChild<QDialog*>("command_search") == nullptr; }));
    return found;
  };
  EXPECT_TRUE(first_found("select all").contains("All"));
  EXPECT_TRUE(first_found("out of sight").contains("Hide"));
  EXPECT_TRUE(first_found("loop cut").contains("Loop Cut"));
}

TEST_F(FirstDay, CutsNothingOffOnASmallScreen) {
  window->resize(1280, 680);
  settle();
  EXPECT_EQ(window->size(), QSize(1280, 680));
  auto* more = find<QToolBar>("tools")->findChild<QToolButton*>("qt_toolbar_ext_button");
  EXPECT_TRUE(more == nullptr || !more->isVisible()) << "all tools are seen";
  auto* selection = find<QDockWidget>("dock_selection");
  if (window->tabifiedDockWidgets(selection).isEmpty()) { // as on a low screen
    window->tabifyDockWidget(find<QDockWidget>("dock_history"), selection);
  }
  settle();
  for (QTabBar* bar : window->findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly)) {
    for (int i = 0; bar->isVisible() && i < bar->count(); ++i) {
      EXPECT_GE(bar->tabRect(i).width(), bar->fontMetrics().horizontalAdvance(bar->tabText(i)) + 8)
          << bar->tabText(i).toStdString();
      EXPECT_LE(bar->tabRect(i).right(), bar->width()) << bar->tabText(i).toStdString();
    }
  }
}

} // namespace
} // namespace cagewright::app
