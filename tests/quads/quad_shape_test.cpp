#include "quads/quad_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

constexpr double right = 90;

QuadCorners square() {
  return {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
}

TEST(QuadShape, OfASquareIsFlatWithRightAngles) {
  const QuadShape shape = shape_of(square());
  EXPECT_NEAR(shape.bend_degrees, 0, 1e-9);
  EXPECT_NEAR(shape.min_angle_degrees, right, 1e-9);
  EXPECT_NEAR(shape.max_angle_degrees, right, 1e-9);
}

TEST(QuadShape, BendIsTheAngleBetweenItsTriangles) {
  for (const double degrees : {10.0, 40.0, 80.0}) {
    QuadCorners q = square();
    // The fourth corner turned about the first diagonal.
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 middle(0.5, 0.5, 0);
    q[3] =
        middle + std::cos(angle) * (q[3] - middle) + Vec3(0, 0, std::sin(angle) * std::sqrt(0.5));
    const QuadShape shape = shape_of(q);
    EXPECT_GE(shape.bend_degrees, degrees - 1e-9);
    EXPECT_LE(shape.bend_degrees, degrees + 15); // along the other diagonal it may be more
  }
}

TEST(QuadShape, OfAConcaveQuadHasAnAngleAbove180) {
  QuadCorners q = square();
  q[2] = {0.3, 0.3, 0};
  EXPECT_GT(shape_of(q).max_angle_degrees, 180);
  q[2] = {0.55, 0.55, 0};
  EXPECT_LT(shape_of(q).max_angle_degrees, 180);
}

TEST(QuadShape, OfAQuadWithoutAreaIsWithinNoLimits) {
  EXPECT_FALSE(shape_of({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)}).within({}));
  EXPECT_FALSE(shape_of({Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}).within({}));
}

TEST(QuadShape, DoesNotDependOnWhereItBeginsOrHowLargeItIs) {
  const QuadCorners q = {Vec3(0, 0, 0.1), Vec3(1, 0.2, 0), Vec3(1.3, 1, 0.3), Vec3(0, 1, 0)};
  const QuadShape shape = shape_of(q);
  for (int k = 1; k < 4; ++k) {
    QuadCorners turned;
    for (int i = 0; i < 4; ++i) {
      turned[i] = 1e-5 * q[(i + k) % 4];
    }
    EXPECT_NEAR(shape_of(turned).bend_degrees, shape.bend_degrees, 1e-6);
    EXPECT_NEAR(shape_of(turned).max_angle_degrees, shape.max_angle_degrees, 1e-6);
  }
}

TEST(FaceDefect, IsLeastForASquareAndUnfitBeyondTheLimits) {
  std::vector<Vec3> x;
  for (const Vec3& p : square()) {
    x.push_back(p);
  }
  const CageFace quad = CageFace::quad(0, 1, 2, 3);
  EXPECT_NEAR(face_defect(x, quad, {}), 0, 1e-9);
  x[2] = {1.4, 1.4, 0};
  const double slanted = face_defect(x, quad, {});
  EXPECT_GT(slanted, 0.01);
  EXPECT_LT(slanted, unfit);
  x[2] = {0.2, 0.2, 0};
  EXPECT_EQ(face_defect(x, quad, {}), unfit);
}

} // namespace
} // namespace cagewright
