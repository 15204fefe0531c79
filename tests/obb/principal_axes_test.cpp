#include "obb/principal_axes.h"

#include "mesh/shapes.h"
#include "obb/test_points.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

void expect_near(const Vec3& actual, const Vec3& expected, double tolerance) {
  EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), tolerance)
      << actual.transpose() << " instead of " << expected.transpose();
}

void expect_frame(const Mat3& axes) {
  EXPECT_LT((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-14);
  EXPECT_GT(axes.determinant(), 0);
}

const std::vector<Vec3>& worked_example() {
  static const std::vector<Vec3> points = {
      {3.7, 1.7, 0}, {4.1, 3.8, 0}, {4.7, 2.9, 0},  {5.2, 2.8, 0},  {6.0, 4.0, 0},
      {6.3, 3.6, 0}, {9.7, 6.3, 0}, {10.0, 4.9, 0}, {11.0, 3.6, 0}, {12.5, 6.4, 0}};
  return points;
}

TEST(PrincipalAxes, OfTheWorkedExampleAreThoseOfTheReference) {
  const PrincipalAxes p = principal_axes(worked_example());
  expect_near(p.mean, {7.32, 4.0, 0}, 1e-12);
  EXPECT_NEAR(p.covariance(0, 0), 9.0836, 1e-10);
  EXPECT_NEAR(p.covariance(0, 1), 3.365, 1e-10);
  EXPECT_NEAR(p.covariance(1, 1), 2.016, 1e-10);
  expect_near(p.variances, {10.4294, 0.670152, 0}, 5e-5);
  expect_near(p.axes.col(0), {0.928491, 0.371355, 0}, 1e-6);
  expect_near(p.axes.col(1), {-0.371355, 0.928491, 0}, 1e-6);
  expect_frame(p.axes);
}

TEST(PcaBox, OfTheWorkedExampleIsThatOfTheReference) {
  const OrientedBox box = pca_box(worked_example());
  expect_near(box.center, {8.10, 4.05, 0}, 5e-3);
  expect_near(box.half, {4.96, 1.49, 0}, 5e-3);
}

TEST(PcaBox, IsCenteredBetweenTheExtremesNotAtTheMean) {
  const std::vector<Vec3> points = {{-5, 0, 0}, {4, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  expect_near(principal_axes(points).mean, {2, 0, 0}, 1e-15);
  expect_near(pca_box(points).center, Vec3::Zero(), 1e-15);
  expect_near(pca_box(points).half, {5, 0, 0}, 1e-15);
}

TEST(PrincipalAxes, FollowATurnedBox) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Mat3 turn = test::rotation(seed);
    const auto points = test::moved(test::points_in_box({3, 2, 1}, 20000, 5), turn, 1, {1, 2, 3});
    const PrincipalAxes p = principal_axes(points);
    expect_frame(p.axes);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(std::abs(p.axes.col(k).dot(turn.col(k))), 0.999);
    }
    expect_near(p.variances, {3, 4.0 / 3, 1.0 / 3}, 0.05);
  }
}

TEST(PrincipalAxes, DoNotDependOnScaleOrPlace) {
  const auto points =
      test::moved(test::points_in_box({3, 2, 1}, 500, 9), test::rotation(4), 1, Vec3::Zero());
  const Mat3 axes = principal_axes(points).axes;
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const auto copy = test::moved(points, Mat3::Identity(), scale, Vec3::Zero());
    EXPECT_LT((principal_axes(copy).axes - axes).norm(), 1e-12) << scale;
    const auto far = test::moved(points, Mat3::Identity(), scale, scale * Vec3(7e5, -7e5, 7e5));
    EXPECT_LT((principal_axes(far).axes - axes).norm(), 1e-8) << scale;
  }
}

TEST(PrincipalAxes, OfCubesAndSpheresAreTheWorlds) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(4e5, -3e5, 1e5)}) {
      for (const TriangleMesh& shape : {make_cube(), make_icosphere(3), make_tetrahedron()}) {
        const auto points = test::moved(shape.positions, Mat3::Identity(), scale, scale * shift);
        EXPECT_EQ(principal_axes(points).axes, Mat3::Identity());
      }
    }
  }
}

TEST(PrincipalAxes, AcrossASquarePrismAreNearestToTheWorlds) {
  // Two variances coincide: which turn about the prism's axis the solver returns is chance.
  for (const Vec3& half : {Vec3(1, 1, 3), Vec3(3, 3, 1)}) {
    for (int degrees = 0; degrees < 90; degrees += 7) {
      const Mat3 turn =
          Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()).toRotationMatrix();
      const TriangleMesh prism = to_mesh({{5, 6, 7}, turn, half});
      const Mat3 axes = principal_axes(prism.positions).axes;
      expect_frame(axes);
      EXPECT_LT((axes.cwiseAbs() * Vec3::Ones() - Vec3::Ones()).norm(), 1e-6) << axes;
    }
  }
}

TEST(PrincipalAxes, OfPointsOnALineBeginWithTheLine) {
  const Vec3 direction = Vec3(1, 2, -2) / 3;
  std::vector<Vec3> points;
  for (int i = 0; i < 5; ++i) {
    points.push_back(Vec3(1, 1, 1) + i * direction);
  }
  const Mat3 axes = principal_axes(points).axes;
  expect_frame(axes);
  EXPECT_NEAR(std::abs(axes.col(0).dot(direction)), 1, 1e-14);
  expect_near(pca_box(points).half, {2, 0, 0}, 1e-14);
}

TEST(PrincipalAxes, OfOnePointOrNoneAreTheWorlds) {
  const std::vector<Vec3> one = {{3, 4, 5}};
  EXPECT_EQ(principal_axes(one).axes, Mat3::Identity());
  EXPECT_EQ(principal_axes(one).mean, Vec3(3, 4, 5));
  EXPECT_EQ(pca_box(one).center, Vec3(3, 4, 5));
  EXPECT_EQ(pca_box(one).volume(), 0);
  EXPECT_EQ(principal_axes({}).axes, Mat3::Identity());
  EXPECT_EQ(pca_box({}).volume(), 0);
}

} // namespace
} // namespace cagewright
