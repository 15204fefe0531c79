#include "symmetry/mirror_plane.h"

#include "core/random.h"
#include "mesh/shapes.h"
#include "support/figures.h"
#include "support/models.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <map>

namespace cagewright {
namespace {

using test::ellipsoid;

// A body with a head, a nose and two arms: its own mirror image in x = 0 and in no other plane.
TriangleMesh figure() {
  TriangleMesh mesh = ellipsoid({0, 0, 0}, {1, 1.6, 0.7}, 3);
  mesh = joined(mesh, ellipsoid({0, 2, 0.2}, {0.6, 0.6, 0.6}, 3));
  mesh = joined(mesh, ellipsoid({0, 2, 0.9}, {0.15, 0.15, 0.3}, 3));
  mesh = joined(mesh, ellipsoid({1.4, 0.6, 0.2}, {0.9, 0.25, 0.25}, 3));
  return joined(mesh, ellipsoid({-1.4, 0.6, 0.2}, {0.9, 0.25, 0.25}, 3));
}

TriangleMesh moved(TriangleMesh mesh, const Mat3& turn, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = scale * (turn * p) + offset;
  }
  return mesh;
}

TEST(MirrorPlane, OfAFigureIsFoundHoweverItStands) {
  const TriangleMesh model = figure();
  Random random(7);
  for (int i = 0; i < 6; ++i) {
    const Vec3 axis =
        Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const Mat3 turn = Eigen::AngleAxisd(random.uniform(0, 6), axis).toRotationMatrix();
    const double scale = std::pow(10.0, random.uniform(-4, 4));
    const Vec3 offset = scale * Vec3(random.uniform(-9, 9), random.uniform(-9, 9), 3);
    const auto plane = detect_mirror_plane(moved(model, turn, scale, offset));
    ASSERT_TRUE(plane);
    EXPECT_NEAR(std::abs(plane->normal.dot(turn.col(0))), 1, 1e-6);
    EXPECT_NEAR(plane->normal.dot(offset), plane->offset, 1e-3 * scale);
    EXPECT_LT(plane->mean_error, 1e-3);
  }
}

TEST(MirrorPlane, IsExactWhereTheModelStandsStraight) {
  const auto plane = detect_mirror_plane(figure());
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->axis(), 0);
  EXPECT_EQ(plane->offset, 0);
  EXPECT_LT(plane->mean_error, 1e-9);
  const auto aside =
      detect_mirror_plane(moved(figure(), Mat3(Mat3::Identity()), 1, {100.25, 3, 4}));
  ASSERT_TRUE(aside);
  EXPECT_EQ(aside->axis(), 0);
  EXPECT_NEAR(aside->offset, 100.25, 1e-9);
}

TEST(MirrorPlane, IsFoundUnderNoise) {
  TriangleMesh model = figure();
  Random random(3);
  const double size = 0.01 * diagonal(model.positions);
  for (Vec3& p : model.positions) {
    p += size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  }
  const auto plane = detect_mirror_plane(model, {.most_mean_error = 0.01, .most_high_error = 0.05});
  ASSERT_TRUE(plane);
  EXPECT_GT(plane->normal.x(), 0.999);
  EXPECT_GT(plane->mean_error, 5e-4);
}

TEST(MirrorPlane, DoesNotDependOnHowTheSurfaceIsCutIntoTriangles) {
  TriangleMesh model = figure();
  // Three small triangles for each on one side.
  const std::vector<Triangle> old = std::exchange(model.triangles, {});
  for (const Triangle& t : old) {
    const Vec3 middle = (model.positions[t[0]] + model.positions[t[1]] + model.positions[t[2]]) / 3;
    if (middle.x() < 0) {
      model.triangles.push_back(t);
      continue;
    }
    const auto m = static_cast<Index>(model.positions.size());
    model.positions.push_back(middle);
    for (int i = 0; i < 3; ++i) {
      model.triangles.push_back({t[i], t[(i + 1) % 3], m});
    }
  }
  const auto plane = detect_mirror_plane(model);
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->axis(), 0);
  EXPECT_EQ(plane->offset, 0);
}

TEST(MirrorPlane, IsNotFoundWhereThereIsNone) {
  TriangleMesh mesh = ellipsoid({0, 0, 0}, {1, 1.6, 0.7}, 3);
  mesh = joined(mesh, ellipsoid({1.2, 0.5, 0.3}, {0.9, 0.3, 0.3}, 3));
  mesh = joined(mesh, ellipsoid({-0.3, 1.5, 0.9}, {0.3, 0.5, 0.8}, 3));
  EXPECT_FALSE(detect_mirror_plane(mesh));
  EXPECT_FALSE(detect_mirror_plane(TriangleMesh()));
  const TriangleMesh point{{{1, 2, 3}}, {{0, 0, 0}}};
  EXPECT_FALSE(detect_mirror_plane(point));
}

TEST(MirrorPlane, OfWhatHasManyIsTheOneAcrossX) {
  for (const TriangleMesh& model : {make_cube(), make_icosphere(3), make_torus(0.3, 48, 24)}) {
    const auto plane = detect_mirror_plane(model);
    ASSERT_TRUE(plane);
    EXPECT_EQ(plane->axis(), 0);
    EXPECT_EQ(plane->offset, 0);
  }
}

TEST(MirrorPlane, AcrossAnAxisIsTheBestThereIs) {
  const TriangleMesh model = moved(figure(), Mat3(Mat3::Identity()), 1, {5, 6, 7});
  EXPECT_NEAR(best_mirror_plane(model, 0)->offset, 5, 1e-9);
  EXPECT_LT(best_mirror_plane(model, 0)->mean_error, 1e-9);
  const auto other = best_mirror_plane(model, 1);
  EXPECT_EQ(other->axis(), 1);
  EXPECT_GT(other->mean_error, 0.01);
}

TEST(MirrorPlane, IsTheSameOnOneThreadAsOnMany) {
  const TriangleMesh model = moved(
      figure(), Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()).toRotationMatrix(), 1, {1, 2, 3});
  const auto many = detect_mirror_plane(model);
  tbb::task_arena(1).execute([&] {
    const auto one = detect_mirror_plane(model);
    EXPECT_EQ(one->normal, many->normal);
    EXPECT_EQ(one->offset, many->offset);
  });
}

TEST(MirrorPlane, OfRealModels) {
  const std::map<std::string, int> axes = {{"spot.obj", 0},    {"homer.off", 0},
                                           {"cow.off", 2},     {"teapot.obj", 2},
                                           {"suzanne.obj", 0}, {"rocker-arm.obj", -2}};
  for (const auto& [name, axis] : axes) {
    const auto model = test::real_model({name});
    if (!model) {
      continue;
    }
    const auto plane = detect_mirror_plane(*model);
    EXPECT_EQ(plane.has_value(), axis != -2) << name;
    if (plane && axis != -2) {
      EXPECT_EQ(plane->axis(), axis) << name;
    }
  }
}

} // namespace
} // namespace cagewright
