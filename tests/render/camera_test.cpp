#include <cagewright/render/camera.h>

#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

/// Position in the frame, from -1 to 1 on both axes.
Eigen::Vector2d projected(const Camera& camera, double aspect, const Vec3& point) {
  const Vec3 p = camera.axes * point - camera.eye;
  return {p.x() / (-p.z() * camera.tan_half_height * aspect),
          p.y() / (-p.z() * camera.tan_half_height)};
}

class FittedCamera : public testing::TestWithParam<const char*> {};

TEST_P(FittedCamera, FillsTheFrameUpToTheMargin) {
  const std::vector<Vec3> points = make_torus(0.3, 40, 20).positions;
  for (const double aspect : {0.5, 1.0, 2.0}) {
    for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
      const Camera camera = fitted_camera(*view_named(GetParam()), up, 24, aspect, 0.05, points);
      Eigen::AlignedBox2d frame;
      for (const Vec3& p : points) {
        frame.extend(projected(camera, aspect, p));
        const double distance = camera.eye.z() - (camera.axes * p).z();
        EXPECT_GT(distance, camera.nearest);
        EXPECT_LT(distance, camera.farthest);
      }
      EXPECT_NEAR(frame.max().cwiseMax(-frame.min()).maxCoeff(), 0.9, 1e-4);
      EXPECT_NEAR(frame.min().x(), -frame.max().x(), 1e-4);
      EXPECT_NEAR(frame.min().y(), -frame.max().y(), 1e-4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Views, FittedCamera,
                         testing::Values("front", "back", "left", "right", "side", "top", "bottom",
                                         "three-quarter"));

TEST(Views, ShowTheSidesTheyAreNamedAfter) {
  const std::vector<Vec3> points = make_cube().positions;
  const auto backward = [&](const char* name, UpAxis up) {
    return Vec3(fitted_camera(*view_named(name), up, 24, 1, 0, points).axes.row(2));
  };
  EXPECT_TRUE(backward("front", UpAxis::y).isApprox(Vec3::UnitZ()));
  EXPECT_TRUE(backward("side", UpAxis::y).isApprox(Vec3::UnitX()));
  EXPECT_TRUE(backward("top", UpAxis::y).isApprox(Vec3::UnitY()));
  EXPECT_TRUE(backward("front", UpAxis::z).isApprox(-Vec3::UnitY()));
  EXPECT_TRUE(backward("side", UpAxis::z).isApprox(Vec3::UnitX()));
  EXPECT_TRUE(backward("top", UpAxis::z).isApprox(Vec3::UnitZ()));
}

TEST(Views, KeepTheUpAxisUprightAndAreRotations) {
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
    const Camera camera = fitted_camera({50, 30}, up, 24, 1, 0, {});
    EXPECT_NEAR(camera.axes.determinant(), 1, 1e-12);
    const Vec3 up_seen = camera.axes * (up == UpAxis::y ? Vec3::UnitY() : Vec3::UnitZ());
    EXPECT_NEAR(up_seen.x(), 0, 1e-12);
    EXPECT_GT(up_seen.y(), 0.5);
  }
}

TEST(Views, HaveNoOtherNames) {
  EXPECT_FALSE(view_named(""));
  EXPECT_FALSE(view_named("Front"));
  EXPECT_FALSE(view_named("inside"));
}

TEST(CameraFitted, StaysInFrontOfAFlatSheetSeenFromItsEdge) {
  const Camera camera =
      fitted_camera({0, 0}, UpAxis::y, 24, 1, 0, {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3::Zero()});
  EXPECT_GT(camera.eye.z(), 1);
  EXPECT_GT(camera.nearest, 0);
}

} // namespace
} // namespace cagewright
