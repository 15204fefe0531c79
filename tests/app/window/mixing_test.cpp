// Two kinds of coordinates in one model, mixed by a painted weight: by mouse and by keys.
#include "window_fixture.h"

#include "app/document/binding.h"
#include <cagewright/coordinates/mixed.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/io/read_vertex_weights.h>

#include <QAbstractItemView>
#include <QComboBox>
#include <QLabel>

#include <numeric>

namespace cagewright::app {
namespace {

class Mixing : public Window {
protected:
  /// As a person would: the list opens, and its line is clicked.
  void choose(const char* box, const char* name) {
    auto* list = find<QComboBox>(box);
    const int line = list->findText(name);
    ASSERT_GE(line, 0);
    list->showPopup();
    QAbstractItemView* lines = list->view();
    const QModelIndex index = list->model()->index(line, 0);
    lines->scrollTo(index);
    QTest::mouseClick(lines->viewport(), Qt::LeftButton, {}, lines->visualRect(index).center());
    ASSERT_TRUE(wait_until([&] { return QApplication::activePopupWidget() == nullptr; }));
    EXPECT_EQ(list->currentText(), name);
    settle();
  }
  void take_brush() {
    click("paint_mix");
    ASSERT_EQ(document().tools().tool, Tool::mix);
    ToolSettings tools = document().tools();
    tools.brush_radius = 90;
    tools.brush_strength = 1;
    document().set_tools(tools);
    settle();
  }
  /// The middle of the model's front, as it is shown.
  QPoint on_model() {
    const Vec3 backward = view().camera().axes().row(2);
    const std::span<const Vec3> p = document().model_positions();
    return at(*std::ranges::max_element(
        p, [&](const Vec3& a, const Vec3& b) { return a.dot(backward) < b.dot(backward); }));
  }
  void stroke(QPoint from, QPoint by, Qt::KeyboardModifiers modifiers = {}) {
    drag(from, from + by, modifiers);
    wait_for_job();
  }
  void pull_the_cage() {
    take_tool(Tool::translate);
    const Index v = front_vertex();
    const QPoint from = at(document().shown_cage_positions()[v]);
    drag(from, from + QPoint(70, 30));
    settle();
  }
  /// Where the kinds take the model, where these are its shares of the second.
  std::vector<Vec3> expected(const SharedShares& shares) {
    const PolygonMesh& rest = document().cage_rest();
    const std::vector<Vec3>& points = document().model()->mesh.positions;
    const std::vector<double> of_second(shares->begin(), shares->end());
    const auto mixed =
        prepare_mixed(rest, *CoordinateSettings::of("mean_value+green"), points, of_second);
    EXPECT_TRUE(mixed);
    const std::vector<std::vector<Vec3>> poses = {cage()};
    return deform_streaming(**mixed, poses, points)->positions[0];
  }
  const SharedShares& mix() { return document().state().mix; }
  const CoordinateChoice& bound() { return document().state().binding->choice(); }
};

TEST_F(Mixing, PaintsWhereAnotherKindHoldsAndTheBoundModelFollows) {
  open_caged();
  EXPECT_FALSE(find<QAbstractButton>("paint_mix")->isVisible());
  choose("mix", "Green");
  EXPECT_TRUE(find<QAbstractButton>("paint_mix")->isVisible());
  bind();
  EXPECT_EQ(bound().settings().name(), "mean_value") << "nothing is painted";
  pull_the_cage();
  const std::vector<Vec3> posed = cage();
  const std::vector<Vec3> by_first = shown();
  take_brush();
  keep("mix-nothing");

  // A stroke on the model as it stands: the pose stays, the model follows.
  const int steps = session().editor().undo_stack().count();
  stroke(on_model(), QPoint(60, 0));
  ASSERT_TRUE(mix());
  const SharedShares first_stroke = mix();
  EXPECT_EQ(session().editor().undo_stack().count(), steps + 1) << "a stroke is one step";
  EXPECT_GT(*std::ranges::max_element(*first_stroke), 0.5F);
  EXPECT_EQ(*std::ranges::min_element(*first_stroke), 0.0F);
  EXPECT_EQ(bound().settings().name(), "mean_value+green");
  EXPECT_EQ(bound().shares, first_stroke);
  EXPECT_EQ(cage(), posed);
  EXPECT_LT(greatest_distance(shown(), expected(first_stroke)), 1e-5);
  EXPECT_GT(greatest_distance(shown(), by_first), 1e-4);
  keep("mix-painted");

  // More of it, and less by Shift; undo and redo take the model along.
  stroke(on_model() + QPoint(0, 60), QPoint(30, 0));
  const SharedShares second_stroke = mix();
  EXPECT_NE(*second_stroke, *first_stroke);
  EXPECT_LT(greatest_distance(shown(), expected(second_stroke)), 1e-5);
  stroke(on_model(), QPoint(60, 0), Qt::ShiftModifier);
  const auto sum = [](const std::vector<float>& shares) {
    return std::accumulate(shares.begin(), shares.end(), 0.0);
  };
  EXPECT_LT(sum(*mix()), sum(*second_stroke));
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  wait_for_job();
  EXPECT_EQ(mix(), first_stroke);
  EXPECT_EQ(bound().shares, first_stroke);
  EXPECT_LT(greatest_distance(shown(), expected(first_stroke)), 1e-5);
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  wait_for_job();
  EXPECT_EQ(mix(), nullptr);
  EXPECT_LT(greatest_distance(shown(), by_first), 1e-9);
  EXPECT_EQ(cage(), posed);
  press_at_focus(Qt::Key_Y, Qt::ControlModifier);
  wait_for_job();
  EXPECT_LT(greatest_distance(shown(), expected(first_stroke)), 1e-5);

  // A stroke that is not meant.
  const QPoint place = on_model();
  QTest::mousePress(&view(), Qt::LeftButton, {}, place + QPoint(0, 80));
  test::move_mouse(view(), place + QPoint(30, 80), Qt::LeftButton);
  press_at_focus(Qt::Key_Escape);
  QTest::mouseRelease(&view(), Qt::LeftButton, {}, place + QPoint(30, 80));
  wait_for_job();
  EXPECT_EQ(mix(), first_stroke);
  EXPECT_EQ(document().shown_mix(), first_stroke);

  trigger("clear_mix");
  wait_for_job();
  EXPECT_LT(greatest_distance(shown(), by_first), 1e-9);
}

TEST_F(Mixing, IsKeptInProjectsAndWritten) {
  open_caged();
  choose("mix", "Green");
  take_brush();
  stroke(on_model(), QPoint(60, 0)); // before it is bound
  const SharedShares painted = mix();
  ASSERT_TRUE(painted);
  click("guide_button");
  wait_for_job();
  ASSERT_EQ(document().mode(), Mode::deform);
  EXPECT_EQ(bound().shares, painted);
  pull_the_cage();
  const std::vector<Vec3> moved = shown();
  EXPECT_LT(greatest_distance(moved, expected(painted)), 1e-5);
  with_file(path("mix.cagewright"), [this] { press(Qt::Key_S, Qt::ControlModifier); });

  with_file(path("shares.txt"), [this] { trigger("export_mix"); });
  wait_for_job();
  const auto shares = read_vertex_weights(path("shares.txt").toStdString(), painted->size());
  ASSERT_TRUE(shares);
  EXPECT_TRUE(std::ranges::equal(*shares, *painted,
                                 [](double a, float b) { return static_cast<float>(a) == b; }));
  with_file(path("weights.npz"), [this] { trigger("export_weights"); });
  wait_for_job();
  const auto stored = read_weights(path("weights.npz").toStdString());
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->settings.name(), "mean_value+green");
  EXPECT_TRUE(belongs_to(*stored, document().model()->mesh.positions, document().cage_rest()));
  with_file(path("moved.obj"), [this] { press(Qt::Key_E, Qt::ControlModifier); });
  wait_for_job();
  const auto exported = read_mesh(path("moved.obj").toStdString());
  ASSERT_TRUE(exported);
  EXPECT_LT(greatest_distance(exported->positions, moved), 1e-5);

  session().open(path("model.obj").toStdString());
  wait_for_job();
  EXPECT_EQ(mix(), nullptr);
  session().open(path("mix.cagewright").toStdString());
  wait_for_job();
  ASSERT_TRUE(mix());
  EXPECT_EQ(*mix(), *painted);
  ASSERT_EQ(document().mode(), Mode::deform);
  EXPECT_EQ(find<QComboBox>("mix")->currentText(), "Green");
  EXPECT_LT(greatest_distance(shown(), moved), 1e-9) << "not one bit else";
}

TEST_F(Mixing, SaysWhatIsMissingAndTakesBackWhatCannotBeBound) {
  open_caged();
  take_tool(Tool::mix);
  ASSERT_FALSE(session().jobs().busy());
  drag(on_model(), on_model() + QPoint(40, 0));
  ASSERT_TRUE(mix());
  EXPECT_TRUE(find<QLabel>("notice")->isVisible()) << "by which kind?";
  bind();
  EXPECT_EQ(bound().settings().name(), "mean_value");
  choose("mix", "Green");
  wait_for_job();
  EXPECT_EQ(bound().settings().name(), "mean_value+green") << "what is painted counts at once";
  EXPECT_LT(greatest_distance(shown(), expected(mix())), 1e-5);

  // Cancelled: what is painted is again what is bound.
  const SharedShares before = mix();
  drag(on_model() + QPoint(0, 50), on_model() + QPoint(40, 50));
  session().cancel();
  wait_for_job();
  EXPECT_EQ(bound().shares, mix());
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  wait_for_job();
  EXPECT_EQ(bound().shares, mix());
  EXPECT_TRUE(before);
}

} // namespace
} // namespace cagewright::app
