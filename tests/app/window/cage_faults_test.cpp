// What once went wrong with cages of quads and with colors of weights, by mouse and by keys.
#include "window_fixture.h"

#include "app/edit/pick.h"
#include "app/view/scene_marks.h"
#include "core/random.h"
#include "edit/quads.h"

#include <QWheelEvent>

#include <array>

namespace cagewright::app {
namespace {

class CageFaults : public Window {
protected:
  void open_quads(const PolygonMesh& cage) {
    ASSERT_TRUE(write_mesh(cage, path("quads.obj").toStdString()));
    session().open(path("model.obj").toStdString(), path("quads.obj").toStdString());
    wait_for_job();
    ASSERT_EQ(document().cage_rest().face_count(), cage.face_count());
  }
  /// Round the model, and none of its quads is flat.
  static PolygonMesh crooked() {
    PolygonMesh cage = test::quad_torus(16, 8);
    Random random(5);
    for (Vec3& p : cage.positions) {
      p += 0.09 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    }
    return cage;
  }
  [[nodiscard]] Vec3 middle_of(Index f) {
    Vec3 sum = Vec3::Zero();
    const std::span<const Index> corners = document().cage_rest().face(f);
    for (const Index v : corners) {
      sum += document().shown_cage_positions()[v];
    }
    return sum / static_cast<double>(corners.size());
  }
  /// Those that a click on their middle would select.
  std::vector<Index> faces_to_be_seen() {
    const PolygonMesh cage = document().cage();
    const CageGraph graph(cage);
    const Picker picker(cage, graph);
    std::vector<Index> seen;
    for (Index f = 0; f < cage.face_count(); ++f) {
      const auto pixel = view().camera().project(middle_of(f));
      const auto hit = pixel ? picker.face_at(view().camera(), pixel->pixel) : std::nullopt;
      if (hit && hit->element == f) {
        seen.push_back(f);
      }
    }
    return seen;
  }
  void wheel(QPoint place, int delta) {
    QWheelEvent event(place, view().mapToGlobal(place), {}, QPoint(0, delta), Qt::NoButton, {},
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&view(), &event);
  }
};

TEST_F(CageFaults, OutlinesSelectEveryFaceThatIsSeenHoweverCrooked) {
  open_quads(crooked());
  press_at_focus(Qt::Key_3);
  for (const char* from : {"front", "three-quarter", "top"}) {
    view().set_standard_view(from);
    view().frame_all();
    settle();
    const std::vector<Index> seen = faces_to_be_seen();
    ASSERT_GT(seen.size(), 20U) << from;
    const auto missed = [&] {
      std::vector<Index> left;
      std::ranges::set_difference(seen, document().selection().faces, std::back_inserter(left));
      return left.size();
    };
    press_at_focus(Qt::Key_A, Qt::AltModifier);
    press_at_focus(Qt::Key_B);
    drag({2, 2}, {view().width() - 3, view().height() - 3});
    settle();
    EXPECT_EQ(missed(), 0U) << "a box, from " << from;
    EXPECT_LT(document().selection().faces.size(), document().cage_rest().face_count())
        << "what is hidden is left alone";

    press_at_focus(Qt::Key_A, Qt::AltModifier);
    const std::array<QPoint, 5> way = {QPoint(2, 2), QPoint(view().width() - 3, 2),
                                       QPoint(view().width() - 3, view().height() - 3),
                                       QPoint(2, view().height() - 3), QPoint(2, 4)};
    test::move_mouse(view(), way[0]);
    QTest::mousePress(&view(), Qt::LeftButton, Qt::ControlModifier, way[0]);
    for (const QPoint& place : way) {
      test::move_mouse(view(), place, Qt::LeftButton, Qt::ControlModifier);
    }
    QTest::mouseRelease(&view(), Qt::LeftButton, Qt::ControlModifier, way.back());
    settle();
    EXPECT_EQ(missed(), 0U) << "a lasso, from " << from;
  }
}

TEST_F(CageFaults, CutsTheOneRingThatIsPointedAtWithPreviewCountAndSlide) {
  open_quads(test::quad_torus(16, 8));
  press_at_focus(Qt::Key_2);
  press_at_focus(Qt::Key_A); // what is selected does not matter
  const PolygonMesh before = document().cage();
  const QUndoStack& stack = session().editor().undo_stack();
  const int steps = stack.count();
  // The front edge that goes along the tube: its ring is round the tube.
  const Vec3 backward = view().camera().axes().row(2);
  EdgeVertices edge{};
  double front = -std::numeric_limits<double>::infinity();
  for (Index f = 0; f < before.face_count(); ++f) {
    const std::span<const Index> c = before.face(f);
    const double depth = (before.positions[c[0]] + before.positions[c[1]]).dot(backward);
    if (depth > front) {
      front = depth;
      edge = {c[0], c[1]};
    }
  }
  const QPoint a = at(before.positions[edge[0]]);
  const QPoint b = at(before.positions[edge[1]]);
  const QPoint place = (a + b) / 2;
  test::move_mouse(view(), place);
  press_at_focus(Qt::Key_R, Qt::ControlModifier);
  ASSERT_TRUE(view().cutting_loops());
  test::move_mouse(view(), place);
  wheel(place, 120);
  keep("loop-cut");
  EXPECT_EQ(document().cage().positions.size(), before.positions.size()) << "only shown yet";
  QTest::mouseClick(&view(), Qt::LeftButton, {}, place);
  test::move_mouse(view(), place + (b - a) / 8);
  keep("loop-slide");
  EXPECT_EQ(document().cage().positions.size(), before.positions.size());
  QTest::mouseClick(&view(), Qt::LeftButton, {}, place + (b - a) / 8);
  EXPECT_FALSE(view().cutting_loops());
  EXPECT_EQ(document().cage().positions.size(), before.positions.size() + 2 * 8)
      << "two loops round one tube";
  EXPECT_EQ(stack.count(), steps + 1);
  EXPECT_TRUE(test::is_sound(document().cage()));
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(document().cage().positions, before.positions);
  press_at_focus(Qt::Key_R, Qt::ControlModifier);
  press_at_focus(Qt::Key_Escape);
  EXPECT_FALSE(view().cutting_loops());
  EXPECT_EQ(document().cage().positions, before.positions);
  EXPECT_EQ(stack.index(), steps);
}

TEST_F(CageFaults, ColorsOfWeightsGoOnBelowZeroAndTheLegendSaysSo) {
  open_caged();
  bind();
  click("weights");
  QTest::mouseClick(&view(), Qt::LeftButton, {},
                    at(document().shown_cage_positions()[front_vertex()]));
  ASSERT_TRUE(wait_until([this] { return !document().model_weights().empty(); }));
  keep("weights-legend");
  // No jump: least at 0, and the farther from it the more colorful.
  const auto differs = [](const Rgb& x, const Rgb& y) {
    return std::max({std::abs(x[0] - y[0]), std::abs(x[1] - y[1]), std::abs(x[2] - y[2])});
  };
  for (float w = least_weight; w < 1; w += 0.005F) {
    EXPECT_LT(differs(weight_rgb(w), weight_rgb(w + 0.005F)), 0.04F) << w;
  }
  EXPECT_GT(differs(weight_rgb(-0.3F), weight_rgb(0)), 0.3F);
  EXPECT_GT(differs(weight_rgb(-0.3F), weight_rgb(0.3F)), 0.3F);
  // Both ends of the legend.
  const QImage picture = view().grabFramebuffer();
  const double ratio = view().devicePixelRatioF();
  const auto seen = [&](double x) {
    const QColor c = picture.pixelColor(static_cast<int>(x * ratio),
                                        static_cast<int>((view().height() - 29) * ratio));
    return Rgb{c.redF(), c.greenF(), c.blueF()};
  };
  EXPECT_LT(differs(seen(view().width() - 190), weight_rgb(least_weight)), 0.1F);
  EXPECT_LT(differs(seen(view().width() - 24), weight_rgb(1)), 0.1F);
}

} // namespace
} // namespace cagewright::app
