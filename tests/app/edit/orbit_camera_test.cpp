#include "app/edit/orbit_camera.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cagewright::app {
namespace {

OrbitCamera some_camera(bool perspective, double size = 1, const Vec3& middle = Vec3(3, -2, 7)) {
  OrbitCamera camera;
  camera.resize(800, 500);
  const Box3 box(Vec3(middle - Vec3(size, size / 2, size / 3)),
                 Vec3(middle + Vec3(size, size / 2, size / 3)));
  camera.set_scene(box);
  camera.frame(box);
  camera.orbit({137, -61});
  camera.set_perspective(perspective);
  return camera;
}

class OrbitCameraIn : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Projections, OrbitCameraIn, testing::Bool());

TEST_P(OrbitCameraIn, RaysPassThroughWhatIsProjectedThere) {
  const OrbitCamera camera = some_camera(GetParam());
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p =
        camera.target() + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto at = camera.project(p);
    ASSERT_TRUE(at);
    const Ray ray = camera.ray(at->pixel);
    EXPECT_LT((p - ray.origin).cross(ray.direction).norm(), 1e-9);
    EXPECT_GT((p - ray.origin).dot(ray.direction), 0) << "the ray starts before the scene";
  }
}

TEST_P(OrbitCameraIn, ClipMatrixAgreesWithProjection) {
  const OrbitCamera camera = some_camera(GetParam());
  const Vec3 center(2.5, -2, 6);
  const double scale = 0.7;
  const Eigen::Matrix4d clip = camera.clip_matrix(center, scale);
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = camera.target() + 0.8 * Vec3(random.uniform(-1, 1), random.uniform(-0.5, 0.5),
                                                random.uniform(-0.3, 0.3));
    const Vec3 q = (p - center) * scale;
    const Eigen::Vector4d c = clip * Eigen::Vector4d(q.x(), q.y(), q.z(), 1);
    const Pixel pixel((c.x() / c.w() + 1) / 2 * camera.width(),
                      (1 - c.y() / c.w()) / 2 * camera.height());
    EXPECT_LT((pixel - camera.project(p)->pixel).norm(), 1e-8);
    EXPECT_LT(std::abs(c.z() / c.w()), 1) << "within the depth range";
  }
}

TEST_P(OrbitCameraIn, FramesAllOfABoxFromEverySide) {
  for (const double size : {1e-6, 1.0, 1e6}) {
    OrbitCamera camera = some_camera(GetParam(), size);
    const Box3 box(Vec3(-size, 0, 0), Vec3(size, size, 3 * size));
    camera.set_scene(box);
    for (int i = 0; i < 20; ++i) {
      camera.orbit({61.0 * i, i % 2 == 0 ? 150.0 : -120.0});
      camera.frame(box);
      double widest = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const auto at = camera.project(box.corner(static_cast<Box3::CornerType>(corner)));
        ASSERT_TRUE(at);
        EXPECT_GE(at->pixel.x(), 0);
        EXPECT_LE(at->pixel.x(), camera.width());
        EXPECT_GE(at->pixel.y(), 0);
        EXPECT_LE(at->pixel.y(), camera.height());
        widest = std::max(widest, std::abs(at->pixel.y() - camera.height() / 2));
      }
      EXPECT_GT(widest, camera.height() / 8) << "and not lost in the middle";
    }
  }
}

TEST_P(OrbitCameraIn, ZoomsTowardsTheCursor) {
  OrbitCamera camera = some_camera(GetParam());
  const Pixel cursor(610, 140);
  const Vec3 there = camera.at_depth_of(camera.target(), cursor);
  const double before = camera.pixel_size(there);
  camera.zoom(5, cursor);
  EXPECT_LT((camera.project(there)->pixel - cursor).norm(), 1e-6);
  EXPECT_LT(camera.pixel_size(there), 0.5 * before);
  camera.zoom(-5, cursor);
  EXPECT_NEAR(camera.pixel_size(there), before, 1e-9);
}

TEST_P(OrbitCameraIn, PansWithTheCursor) {
  OrbitCamera camera = some_camera(GetParam());
  const Vec3 grabbed = camera.at_depth_of(camera.target(), {200, 300});
  camera.pan({35, -80});
  EXPECT_LT((camera.project(grabbed)->pixel - Pixel(235, 220)).norm(), 1e-6);
}

TEST_P(OrbitCameraIn, MeasuresPixels) {
  const OrbitCamera camera = some_camera(GetParam());
  const Vec3 p = camera.target();
  const Vec3 right = camera.axes().row(0);
  const auto moved = camera.project(p + 10 * camera.pixel_size(p) * right);
  EXPECT_NEAR(moved->pixel.x() - camera.project(p)->pixel.x(), 10, 1e-9);
}

TEST(OrbitCamera, LooksAlongTheAxesInStandardViews) {
  OrbitCamera camera;
  const auto to_viewer = [&](StandardView view) -> Vec3 {
    camera.look(view);
    return camera.axes().row(2);
  };
  EXPECT_TRUE(to_viewer(StandardView::front).isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(to_viewer(StandardView::back).isApprox(Vec3(0, 0, -1)));
  EXPECT_TRUE(to_viewer(StandardView::right).isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(to_viewer(StandardView::left).isApprox(Vec3(-1, 0, 0)));
  EXPECT_TRUE(to_viewer(StandardView::top).isApprox(Vec3(0, 1, 0)));
  EXPECT_TRUE(to_viewer(StandardView::bottom).isApprox(Vec3(0, -1, 0)));
  camera.look(StandardView::top);
  camera.look_opposite();
  EXPECT_TRUE(Vec3(camera.axes().row(2)).isApprox(Vec3(0, -1, 0)));
}

TEST(OrbitCamera, KeepsTheTargetInPlaceAndSizeWhenTheProjectionChanges) {
  OrbitCamera camera = some_camera(true);
  const Vec3 p = camera.target() + 0.1 * camera.axes().row(1).transpose();
  const Pixel before = camera.project(p)->pixel;
  camera.set_perspective(false);
  EXPECT_LT((camera.project(p)->pixel - before).norm(), 1e-9);
}

TEST(OrbitCamera, DoesNotTipOverThePoles) {
  OrbitCamera camera = some_camera(true);
  camera.orbit({0, 1e5});
  EXPECT_NEAR(camera.view().pitch_degrees, 90, 1e-12);
  EXPECT_TRUE(camera.axes().allFinite());
  camera.orbit({0, -1e6});
  EXPECT_NEAR(camera.view().pitch_degrees, -90, 1e-12);
}

TEST(OrbitCamera, ProjectsNothingFromBehindTheEye) {
  const OrbitCamera camera = some_camera(true);
  const Vec3 behind = camera.eye() + camera.axes().row(2).transpose();
  EXPECT_FALSE(camera.project(behind));
}

TEST(OrbitCamera, IgnoresNonsenseWhenRestored) {
  OrbitCamera camera = some_camera(true);
  const Vec3 target = camera.target();
  camera.restore({NAN, 0, 0}, 1, {}, false);
  EXPECT_EQ(camera.target(), target);
  EXPECT_FALSE(camera.is_perspective());
  camera.restore({1, 2, 3}, -1, {}, true);
  EXPECT_EQ(camera.target(), target);
}

} // namespace
} // namespace cagewright::app
