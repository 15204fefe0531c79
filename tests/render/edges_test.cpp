#include "render/edges.h"

#include "mesh/shapes.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

/// Every face with vertices of its own, as in an STL file.
PolygonMesh taken_apart(const PolygonMesh& mesh) {
  PolygonMesh result;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> corners;
    for (const Index v : mesh.face(f)) {
      corners.push_back(static_cast<Index>(result.positions.size()));
      result.positions.push_back(mesh.positions[v]);
    }
    result.add_face(corners);
  }
  return result;
}

TEST(PolygonEdges, AreTheTwelveSidesOfACubeOfQuads) {
  EXPECT_EQ(polygon_edges(make_quad_cube()).size(), 12);
  EXPECT_EQ(polygon_edges(PolygonMesh(make_cube())).size(), 18); // its diagonals are sides
}

TEST(PolygonEdges, CountPointsAtTheSamePlaceAsOne) {
  EXPECT_EQ(polygon_edges(taken_apart(make_quad_cube())).size(), 12);
  EXPECT_EQ(used_points(taken_apart(make_quad_cube())).size(), 8);
}

TEST(PolygonEdges, LeaveOutSidesWithoutLength) {
  PolygonMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 1, 0)};
  mesh.add_face({0, 1, 2, 3});
  EXPECT_EQ(polygon_edges(mesh).size(), 3);
}

TEST(PolygonEdges, CanLeaveOutTheFlatOnes) {
  const auto bent = polygon_edges(PolygonMesh(make_cube()), 1);
  EXPECT_EQ(bent.size(), 12);
  EXPECT_EQ(end_points(bent).size(), 8);
  PolygonMesh open; // its border stays
  open.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  open.add_face({0, 1, 2});
  open.add_face({0, 2, 3});
  EXPECT_EQ(polygon_edges(open, 1).size(), 4);
}

TEST(UsedPoints, LeaveOutStrays) {
  PolygonMesh cube = make_quad_cube();
  cube.positions.emplace_back(50, 50, 50);
  EXPECT_EQ(used_points(cube).size(), 8);
}

TEST(MergedPoints, NameTheFirstAtEachPlace) {
  const std::vector<Vec3> points = {Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(-0.0, 0, 0)};
  EXPECT_EQ(merged_points(points), (std::vector<Index>{0, 1, 0, 1}));
}

} // namespace
} // namespace cagewright
