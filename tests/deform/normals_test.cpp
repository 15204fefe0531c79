#include <cagewright/deform/normals.h>

#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <vector>

namespace cagewright {
namespace {

/// The cube with one slot for each corner of its faces, so that all edges are hard.
NormalSlots hard_edges(const PolygonMesh& mesh) {
  NormalSlots slots;
  for (Index c = 0; c < mesh.corners().size(); ++c) {
    slots.of_corner.push_back(c);
  }
  slots.count = slots.of_corner.size();
  return slots;
}

TEST(NormalField, OfASpherePointsOutward) {
  const PolygonMesh sphere(make_icosphere(3));
  for (const NormalWeighting weighting : {NormalWeighting::area, NormalWeighting::angle}) {
    const NormalField field(sphere, smooth_normals(sphere), weighting);
    for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
      EXPECT_GT(field.normals()[v].dot(sphere.positions[v]), 0.999);
      EXPECT_NEAR(field.normals()[v].norm(), 1, 1e-14);
    }
  }
}

TEST(NormalField, ByAngleDoesNotDependOnHowTheCubeIsCut) {
  const PolygonMesh cube(make_cube());
  const NormalField field(cube, smooth_normals(cube), NormalWeighting::angle);
  for (std::size_t v = 0; v < 8; ++v) {
    EXPECT_LT((field.normals()[v] - cube.positions[v].normalized()).norm(), 1e-14);
  }
}

TEST(NormalField, KeepsHardEdges) {
  PolygonMesh cube(make_cube());
  NormalField field(cube, hard_edges(cube));
  cube.positions[7] += Vec3(0.5, 0.25, 0.125);
  field.update(cube.positions);
  for (std::size_t f = 0; f < cube.face_count(); ++f) {
    const auto x = [&](std::size_t i) { return cube.positions[cube.face(f)[i]]; };
    const Vec3 normal = (x(1) - x(0)).cross(x(2) - x(0)).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT((field.normals()[3 * f + k] - normal).norm(), 1e-14);
    }
  }
}

TEST(NormalField, KeepsTheDeviationOfGivenNormals) {
  PolygonMesh sphere(make_icosphere(2));
  NormalSlots slots = smooth_normals(sphere);
  const Mat3 tilt = Eigen::AngleAxisd(0.2, Vec3::UnitZ()).toRotationMatrix();
  for (const Vec3& p : sphere.positions) {
    slots.given.push_back(tilt * p.normalized());
  }
  NormalField field(sphere, slots);
  const std::vector<Vec3> given = slots.given;
  ASSERT_TRUE(std::equal(given.begin(), given.end(), field.normals().begin()));

  const Mat3 turn = Eigen::AngleAxisd(0.6, Vec3::UnitZ()).toRotationMatrix();
  for (Vec3& p : sphere.positions) {
    p = turn * p;
  }
  field.update(sphere.positions);
  double worst = 0;
  for (std::size_t v = 0; v < given.size(); ++v) {
    // The shortest rotation of each mean leaves out the turn about the mean itself.
    worst = std::max(worst, (field.normals()[v] - turn * given[v]).norm());
    EXPECT_NEAR(field.normals()[v].norm(), 1, 1e-12);
  }
  EXPECT_LT(worst, 0.13);
  for (Vec3& p : sphere.positions) {
    p = turn.transpose() * p;
  }
  field.update(sphere.positions);
  for (std::size_t v = 0; v < given.size(); ++v) {
    EXPECT_LT((field.normals()[v] - given[v]).norm(), 1e-12);
  }
}

TEST(NormalField, LooksOnlyWhereVerticesMoved) {
  PolygonMesh torus(make_torus(0.3, 40, 20));
  NormalField field(torus, smooth_normals(torus));
  const std::vector<Vec3> before(field.normals().begin(), field.normals().end());
  for (Vec3& p : torus.positions) {
    p.x() *= 2; // all normals change, but only one tile is told
  }
  std::vector<std::uint8_t> moved(torus.positions.size() / 16, 0);
  moved[10] = 1;
  field.update(torus.positions, moved);
  std::size_t changed = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    changed += field.normals()[v] != before[v] ? 1U : 0U;
    if (v / 16 == 10) {
      EXPECT_NE(field.normals()[v], before[v]);
    }
  }
  EXPECT_LT(changed, 100U); // the tile and its neighbours
}

TEST(NormalField, IsTheSameWhetherAllOrOnlyMovedVerticesAreLookedAt) {
  PolygonMesh torus(make_torus(0.3, 40, 20));
  for (const NormalWeighting weighting : {NormalWeighting::area, NormalWeighting::angle}) {
    NormalField some(torus, hard_edges(torus), weighting);
    NormalField all = some;
    std::vector<Vec3> positions = torus.positions;
    std::vector<std::uint8_t> moved((positions.size() + 15) / 16, 0);
    for (const std::size_t v : {3U, 400U, 411U, 799U}) {
      positions[v] += Vec3(0.1, 0.2, 0.05);
      moved[v / 16] = 1;
    }
    some.update(positions, moved);
    all.update(positions);
    for (std::size_t n = 0; n < all.normals().size(); ++n) {
      ASSERT_EQ(some.normals()[n], all.normals()[n]) << n;
    }
  }
}

TEST(NormalField, IsZeroWhereAllFacesAreDegenerate) {
  PolygonMesh sliver;
  sliver.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  sliver.add_face({0, 1, 2});
  const NormalField field(sliver, smooth_normals(sliver));
  for (const Vec3& n : field.normals()) {
    EXPECT_EQ(n, Vec3::Zero());
  }
}

TEST(NormalField, WorksAtAnySize) {
  for (const double size : {1e-150, 1e-6, 1e6}) {
    PolygonMesh sphere(make_icosphere(1));
    for (Vec3& p : sphere.positions) {
      p *= size;
    }
    const NormalField field(sphere, smooth_normals(sphere));
    EXPECT_NEAR(field.normals()[3].norm(), 1, 1e-12);
  }
}

} // namespace
} // namespace cagewright
