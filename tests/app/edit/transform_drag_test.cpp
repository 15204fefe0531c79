#include "app/edit/transform_drag.h"

#include "app/edit/gizmo.h"
#include "core/random.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace cagewright::app {
namespace {

DragScene some_scene(bool perspective = true) {
  DragScene scene;
  scene.camera.resize(800, 600);
  const Box3 box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  scene.camera.set_scene(box);
  scene.camera.frame(box);
  scene.camera.orbit({-110, 80});
  scene.camera.set_perspective(perspective);
  scene.pivot = Vec3(0.2, -0.1, 0.3);
  scene.unit = 2;
  return scene;
}

Pixel at(const DragScene& scene, const Vec3& p) {
  return scene.camera.project(p)->pixel;
}

void type(TransformDrag& drag, const std::string& text) {
  for (const char c : text) {
    drag.key(c);
  }
}

class DragIn : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Projections, DragIn, testing::Bool());

TEST_P(DragIn, FreeMovesFollowTheCursor) {
  const DragScene scene = some_scene(GetParam());
  TransformDrag drag;
  drag.begin(TransformKind::translate, scene, at(scene, scene.pivot));
  const Pixel cursor(520, 190);
  drag.move(cursor);
  const Vec3 moved = drag.transform().apply(scene.pivot);
  EXPECT_LT((at(scene, moved) - cursor).norm(), 1e-6);
  EXPECT_NEAR((moved - scene.pivot).dot(scene.camera.axes().row(2)), 0, 1e-9)
      << "across the line of sight";
}

TEST_P(DragIn, HandlesOfAxesFollowTheCursorAlongTheAxis) {
  const DragScene scene = some_scene(GetParam());
  for (const Handle handle : {Handle::x, Handle::y, Handle::z}) {
    const Vec3 axis = Vec3::Unit(axis_of(handle));
    for (const double distance : {0.1, -0.2, 0.5}) {
      TransformDrag drag;
      const Pixel start = at(scene, scene.pivot);
      drag.begin(TransformKind::translate, scene, start, handle);
      drag.move(at(scene, scene.pivot + distance * axis));
      EXPECT_LT((drag.transform().shift - distance * axis).norm(), 1e-6);
    }
  }
}

TEST_P(DragIn, HandlesOfPlanesKeepThePivotUnderTheCursor) {
  const DragScene scene = some_scene(GetParam());
  for (const Handle handle : {Handle::yz, Handle::zx, Handle::xy}) {
    const int across = axis_of(handle);
    Vec3 shift(0.3, -0.2, 0.25);
    shift[across] = 0;
    TransformDrag drag;
    drag.begin(TransformKind::translate, scene, at(scene, scene.pivot), handle);
    drag.move(at(scene, scene.pivot + shift));
    EXPECT_LT((drag.transform().shift - shift).norm(), 1e-6);
  }
}

TEST_P(DragIn, NothingRunsAwayAtGrazingAngles) {
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    DragScene scene = some_scene(GetParam());
    const double yaw = random.uniform(-0.2, 0.2); // looking nearly along an axis
    scene.camera.restore(Vec3::Zero(), 6, {yaw, random.uniform(-0.2, 0.2)}, GetParam());
    scene.pivot = Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0);
    const double pixel = scene.camera.pixel_size(scene.pivot);
    for (const Handle handle :
         {Handle::x, Handle::y, Handle::z, Handle::yz, Handle::zx, Handle::xy}) {
      TransformDrag drag;
      const Pixel start = at(scene, scene.pivot);
      drag.begin(TransformKind::translate, scene, start, handle);
      const Pixel step(random.uniform(-40, 40), random.uniform(-40, 40));
      drag.move(start + step);
      const Vec3 shift = drag.transform().shift;
      ASSERT_TRUE(shift.allFinite());
      EXPECT_LE(shift.norm(), 15 * step.norm() * pixel) << static_cast<int>(handle);
    }
  }
}

TEST_P(DragIn, RingsTurnByTheAngleTheCursorGoesRound) {
  const DragScene scene = some_scene(GetParam());
  for (const Handle handle : {Handle::x, Handle::y, Handle::z}) {
    const Vec3 axis = Vec3::Unit(axis_of(handle));
    const Vec3 arm = 0.3 * axis.unitOrthogonal();
    TransformDrag drag;
    drag.begin(TransformKind::rotate, scene, at(scene, scene.pivot + arm), handle);
    double angle = 0;
    for (int i = 0; i < 50; ++i) { // more than a full turn
      angle += 0.2;
      drag.move(at(scene, scene.pivot + Eigen::AngleAxisd(angle, axis) * arm));
    }
    const Transform t = drag.transform();
    EXPECT_NEAR(t.angle * t.axis.dot(axis), angle, 1e-6) << static_cast<int>(handle);
  }
}

TEST_P(DragIn, ScalesByTheDistanceFromThePivot) {
  const DragScene scene = some_scene(GetParam());
  TransformDrag drag;
  const Pixel middle = at(scene, scene.pivot);
  drag.begin(TransformKind::scale, scene, middle + Pixel(100, 0));
  drag.move(middle + Pixel(0, 150));
  EXPECT_TRUE(drag.transform().factors.isApprox(Vec3::Constant(1.5)));
  drag.key('y');
  EXPECT_TRUE(drag.transform().factors.isApprox(Vec3(1, 1.5, 1)));
  drag.key('y');
  drag.key('z', true);
  EXPECT_TRUE(drag.transform().factors.isApprox(Vec3(1.5, 1.5, 1)));
}

TEST(Drag, TypedNumbersWinOverTheMouse) {
  const DragScene scene = some_scene();
  TransformDrag drag;
  drag.begin(TransformKind::translate, scene, {400, 300});
  drag.move({500, 350});
  drag.key('x');
  type(drag, "-1.25");
  EXPECT_EQ(drag.transform().shift, Vec3(-1.25, 0, 0));
  drag.move({100, 100});
  EXPECT_EQ(drag.transform().shift, Vec3(-1.25, 0, 0));
  drag.key(TransformDrag::backspace);
  EXPECT_EQ(drag.transform().shift, Vec3(-1.2, 0, 0));
  drag.key('-');
  EXPECT_EQ(drag.transform().shift, Vec3(1.2, 0, 0));
  for (int i = 0; i < 5; ++i) {
    drag.key(TransformDrag::backspace);
  }
  EXPECT_NE(drag.transform().shift, Vec3(1.2, 0, 0)) << "and back to the mouse";
}

TEST(Drag, TabGoesToTheNextNumber) {
  TransformDrag drag;
  drag.begin(TransformKind::translate, some_scene(), {400, 300});
  type(drag, "1\t2\t-3");
  EXPECT_EQ(drag.transform().shift, Vec3(1, 2, -3));
  drag.key('z', true); // to the plane of x and y
  EXPECT_EQ(drag.transform().shift, Vec3(1, 2, 0));
}

TEST(Drag, TypedAnglesAreDegreesAndFactorsCountForAllAxes) {
  TransformDrag drag;
  drag.begin(TransformKind::rotate, some_scene(), {400, 300});
  drag.key('z');
  type(drag, "90");
  EXPECT_TRUE(drag.transform()
                  .apply(some_scene().pivot + Vec3(1, 0, 0))
                  .isApprox(some_scene().pivot + Vec3(0, 1, 0)));
  drag.key('s');
  type(drag, "2");
  EXPECT_EQ(drag.transform().factors, Vec3(2, 2, 2));
}

TEST(Drag, AxisKeysGoFromWorldToLocalToFree) {
  DragScene scene = some_scene();
  scene.local = Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  TransformDrag drag;
  drag.begin(TransformKind::translate, scene, {400, 300});
  drag.key('x');
  type(drag, "2");
  EXPECT_TRUE(drag.transform().shift.isApprox(Vec3(2, 0, 0)));
  drag.key('x');
  EXPECT_TRUE(drag.transform().shift.isApprox(Vec3(2 * scene.local.col(0))));
  EXPECT_NE(drag.caption().find("local X"), std::string::npos) << drag.caption();
  drag.key('x');
  EXPECT_EQ(drag.freedom(), TransformDrag::Freedom::free);
  drag.key('y');
  drag.key('z');
  EXPECT_EQ(drag.axis(), 2);
  EXPECT_TRUE(drag.transform().shift.isApprox(Vec3(0, 0, 2)));
}

TEST(Drag, SnapsToSteps) {
  DragScene scene = some_scene();
  scene.snap_step = 0.05; // of a unit of 2
  TransformDrag drag;
  drag.begin(TransformKind::translate, scene, {400, 300});
  drag.set_snapping(true);
  drag.key('x');
  for (int i = 0; i < 40; ++i) {
    drag.move({400.0 + 7 * i, 300.0 + 3 * i});
    const double steps = drag.transform().shift.x() / 0.1;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
  EXPECT_NE(drag.transform().shift.x(), 0);
  drag.key('r');
  drag.move({100, 80});
  const double turns = drag.transform().angle / (15 * std::numbers::pi / 180);
  EXPECT_NEAR(turns, std::round(turns), 1e-9);
}

TEST(Drag, PreciseMovesCountForATenthFromThereOn) {
  const DragScene scene = some_scene();
  TransformDrag drag;
  drag.begin(TransformKind::translate, scene, {400, 300});
  drag.move({450, 300});
  const Vec3 before = drag.transform().shift;
  drag.set_precise(true);
  EXPECT_EQ(drag.transform().shift, before) << "no jump";
  drag.move({500, 300});
  EXPECT_TRUE(drag.transform().shift.isApprox(1.1 * before, 1e-9));
}

TEST(Drag, CancelledOnesDoNothing) {
  TransformDrag drag;
  drag.begin(TransformKind::translate, some_scene(), {400, 300});
  drag.move({450, 310});
  EXPECT_FALSE(drag.transform().is_identity());
  EXPECT_TRUE(drag.key(TransformDrag::escape));
  EXPECT_EQ(drag.state(), TransformDrag::State::cancelled);
  EXPECT_TRUE(drag.transform().is_identity());
  EXPECT_FALSE(drag.key('x')) << "it is over";
}

TEST(Drag, EnterConfirmsWhatWasDone) {
  TransformDrag drag;
  drag.begin(TransformKind::translate, some_scene(), {400, 300});
  type(drag, "x3");
  drag.key(TransformDrag::enter);
  EXPECT_EQ(drag.state(), TransformDrag::State::confirmed);
  drag.move({0, 0});
  EXPECT_EQ(drag.transform().shift, Vec3(3, 0, 0));
}

TEST(Drag, SurvivesAnyKeys) {
  Random random(12);
  const std::string keys = "xyzgrs0123456789.-,\b\t";
  for (int round = 0; round < 200; ++round) {
    TransformDrag drag;
    drag.begin(static_cast<TransformKind>(random.below(3)), some_scene(random.below(2) == 0),
               {400, 300}, static_cast<Handle>(random.below(9)));
    for (int i = 0; i < 30; ++i) {
      drag.key(keys[random.below(keys.size())], random.below(2) == 0);
      drag.move({random.uniform(0, 800), random.uniform(0, 600)});
      const Vec3 p = drag.transform().apply({1, 2, 3}, 0.5);
      ASSERT_TRUE(p.allFinite());
      ASSERT_FALSE(drag.caption().empty());
    }
  }
}

// ---------------------------------------------------------------- the gizmo

TEST(Gizmo, IsAsLargeOnTheScreenWhereverItStands) {
  DragScene scene = some_scene();
  const auto size = [&] {
    const GizmoFrame frame{scene.pivot, Mat3::Identity()};
    double largest = 0;
    for (const GizmoShape& shape : gizmo_shapes(scene.camera, TransformKind::rotate, frame)) {
      for (const Vec3& p : shape.points) {
        largest = std::max(largest, (at(scene, p) - at(scene, scene.pivot)).norm());
      }
    }
    return largest;
  };
  const double before = size();
  scene.camera.zoom(6, {400, 300});
  EXPECT_NEAR(size(), before, 0.1 * before);
}

TEST(Gizmo, HandlesAreHitWhereTheyAreDrawn) {
  const DragScene scene = some_scene();
  const GizmoFrame frame{scene.pivot, Mat3::Identity()};
  for (const TransformKind kind :
       {TransformKind::translate, TransformKind::rotate, TransformKind::scale}) {
    int found = 0;
    for (const GizmoShape& shape : gizmo_shapes(scene.camera, kind, frame)) {
      Vec3 middle = Vec3::Zero();
      for (const Vec3& p : shape.points) {
        middle += p / static_cast<double>(shape.points.size());
      }
      const Vec3 p = shape.filled ? middle : shape.points[shape.points.size() / 3];
      found += handle_at(scene.camera, kind, frame, at(scene, p)) == shape.handle ? 1 : 0;
    }
    EXPECT_GE(found, 5) << static_cast<int>(kind);
  }
  EXPECT_EQ(handle_at(scene.camera, TransformKind::translate, frame, {5, 5}), Handle::none);
}

TEST(Gizmo, LeavesOutAxesThatPointAtTheViewer) {
  DragScene scene = some_scene();
  scene.camera.look(StandardView::front);
  scene.camera.set_perspective(false);
  for (const GizmoShape& shape :
       gizmo_shapes(scene.camera, TransformKind::translate, {scene.pivot, Mat3::Identity()})) {
    EXPECT_NE(shape.handle, Handle::z);
    EXPECT_NE(shape.handle, Handle::yz);
    EXPECT_NE(shape.handle, Handle::zx);
  }
}

} // namespace
} // namespace cagewright::app
