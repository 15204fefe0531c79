#include <cagewright/deform/standard_poses.h>

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <vector>

namespace cagewright {
namespace {

/// A box of sizes 1 x 4 x 2 about (5, 6, 7), full of points.
std::vector<Vec3> block() {
  Random random(3);
  std::vector<Vec3> points = {{4.5, 4, 6}, {5.5, 8, 8}};
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(random.uniform(4.5, 5.5), random.uniform(4, 8), random.uniform(6, 8));
  }
  return points;
}

TEST(StandardPoses, BendAboutTheMiddleOfTheLongestAxisTowardsTheShortest) {
  const PoseFrame frame = pose_frame(block());
  EXPECT_EQ(frame.along, Vec3(0, 1, 0));
  EXPECT_EQ(frame.toward, Vec3(1, 0, 0));
  EXPECT_EQ(frame.length, 4);
  const Vec3 center(5, 6, 7);
  EXPECT_LT((posed(StandardPose::bend, frame, center) - center).norm(), 1e-14);
  // The ends turn by 45 degrees each, both towards +x, and the spine keeps its length.
  const double radius = 4 / (std::acos(-1) / 2);
  const Vec3 top = posed(StandardPose::bend, frame, {5, 8, 7});
  const Vec3 bottom = posed(StandardPose::bend, frame, {5, 4, 7});
  const double half = std::sqrt(0.5);
  EXPECT_LT((top - (center + radius * Vec3(1 - half, half, 0))).norm(), 1e-14);
  EXPECT_LT((bottom - (center + radius * Vec3(1 - half, -half, 0))).norm(), 1e-14);
}

TEST(StandardPoses, TwistByNinetyDegreesFromEndToEnd) {
  const PoseFrame frame = pose_frame(block());
  const auto direction = [&](double y) {
    return Vec3(posed(StandardPose::twist, frame, {5.5, y, 7}) - Vec3(5, y, 7));
  };
  EXPECT_LT((direction(6) - Vec3(0.5, 0, 0)).norm(), 1e-14);
  EXPECT_NEAR(direction(4).dot(direction(8)), 0, 1e-14);
  EXPECT_LT((direction(9) - direction(8)).norm(), 1e-14);
}

TEST(StandardPoses, AreOneToOneOnTheBox) {
  // The bend keeps the side that faces its center longer than nothing: no point of a cube comes to
  // the center of the circle. Volume elements stay positive.
  const PoseFrame frame = pose_frame(make_cube().positions);
  Random random(5);
  for (const StandardPose pose : standard_poses) {
    for (int i = 0; i < 500; ++i) {
      const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      Mat3 jacobian;
      constexpr double h = 1e-6;
      for (int k = 0; k < 3; ++k) {
        jacobian.col(k) = (posed(pose, frame, p + h * Vec3::Unit(k)) -
                           posed(pose, frame, p - h * Vec3::Unit(k))) /
                          (2 * h);
      }
      EXPECT_GT(jacobian.determinant(), 0.1) << name_of(pose);
    }
  }
}

TEST(StandardPoses, AreCarriedTheBetterTheFinerTheCage) {
  const TriangleMesh model = make_icosphere(3);
  double last_bend = 1;
  double last_twist = 1;
  for (const int fineness : {0, 1, 2}) {
    TriangleMesh cage = make_icosphere(fineness);
    for (Vec3& p : cage.positions) {
      p *= 1.4;
    }
    const auto errors = pose_errors(PolygonMesh(cage), model.positions);
    ASSERT_TRUE(errors) << errors.error().message;
    EXPECT_EQ(errors->undefined, 0U);
    const double bend = errors->of[0].mean;
    const double twist = errors->of[1].mean;
    EXPECT_GT(bend, 0);
    EXPECT_LT(bend, last_bend);
    EXPECT_LT(twist, last_twist);
    EXPECT_GE(errors->of[0].max, bend);
    last_bend = bend;
    last_twist = twist;
  }
  EXPECT_LT(last_bend, 0.035);
}

TEST(StandardPoses, DoNotDependOnTheUnitOrTheThreads) {
  TriangleMesh model = make_torus(0.3, 24, 12);
  TriangleMesh cage = make_torus(0.45, 12, 6);
  const auto reference = pose_errors(PolygonMesh(cage), model.positions);
  ASSERT_TRUE(reference);
  tbb::task_arena one(1);
  const auto alone = one.execute([&] { return pose_errors(PolygonMesh(cage), model.positions); });
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->of[0].mean, reference->of[0].mean);
  EXPECT_EQ(alone->of[1].max, reference->of[1].max);
  for (TriangleMesh* mesh : {&model, &cage}) {
    for (Vec3& p : mesh->positions) {
      p = 1e-6 * p + Vec3(1e-4, 0, -1e-4);
    }
  }
  const auto small = pose_errors(PolygonMesh(cage), model.positions);
  ASSERT_TRUE(small);
  EXPECT_NEAR(small->of[0].mean, reference->of[0].mean, 1e-8);
  EXPECT_NEAR(small->of[1].mean, reference->of[1].mean, 1e-8);
}

TEST(StandardPoses, RefuseACageWithoutFaces) {
  const auto errors = pose_errors(PolygonMesh(), make_cube().positions);
  ASSERT_FALSE(errors);
  EXPECT_EQ(errors.error().code, ErrorCode::invalid_cage);
}

} // namespace
} // namespace cagewright
