#include <cagewright/mesh/triangulate.h>

#include "mesh/concave.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

PolygonMesh single_face(std::vector<Vec3> corners) {
  PolygonMesh mesh;
  std::vector<Index> face(corners.size());
  std::iota(face.begin(), face.end(), 0U);
  mesh.positions = std::move(corners);
  mesh.add_face(face);
  return mesh;
}

TEST(Triangulate, CutsAQuadFromItsFirstCorner) {
  const Triangulation cut = triangulate(single_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(cut.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(cut.face_of, (std::vector<Index>{0, 0}));
}

TEST(Triangulate, CutsAConcaveQuadAtItsReflexCorner) {
  // An arrowhead: concave at corner 1, so the diagonal must start there.
  const TriangleMesh cut =
      to_triangle_mesh(single_face({{0, 0, 0}, {1, 0.9, 0}, {2, 0, 0}, {1, 2, 0}}));
  EXPECT_DOUBLE_EQ(surface_area(cut), 1.1);
}

TEST(Triangulate, KeepsTheAreaOfAConcavePolygon) {
  const PolygonMesh comb = single_face({{0, 0, 1},
                                        {5, 0, 1},
                                        {5, 3, 1},
                                        {4, 3, 1},
                                        {4, 1, 1},
                                        {3, 1, 1},
                                        {3, 3, 1},
                                        {2, 3, 1},
                                        {2, 1, 1},
                                        {1, 1, 1},
                                        {1, 3, 1},
                                        {0, 3, 1}});
  const TriangleMesh cut = to_triangle_mesh(comb);
  EXPECT_EQ(cut.triangles.size(), 10U);
  EXPECT_DOUBLE_EQ(surface_area(cut), 11);
}

TEST(Triangulate, GivesTwoTrianglesFewerThanCornersWhateverTheShape) {
  const PolygonMesh bow_tie = single_face({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
  EXPECT_EQ(triangulate(bow_tie).triangles.size(), 3U);
  const PolygonMesh point =
      single_face({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
  EXPECT_EQ(triangulate(point).triangles.size(), 4U);
}

/// The sum of the triangles' areas with their signs, seen from above, and how many are turned over.
std::pair<double, int> signed_area_from_above(const PolygonMesh& mesh) {
  double sum = 0;
  int turned = 0;
  for (const Triangle& t : triangulate(mesh).triangles) {
    const Vec3& a = mesh.positions[t[0]];
    const double area = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).z() / 2;
    sum += area;
    turned += area < 0 ? 1 : 0;
  }
  return {sum, turned};
}

// A square of side 10 with a square hole of side 4, joined by a bridge that is walked twice; the
// outline may begin at any corner, and the bridge at any corner of the hole.
TEST(Triangulate, LeavesTheHoleOfAKeyholeOpen) {
  for (int bridge = 0; bridge < 4; ++bridge) {
    for (std::size_t start = 0; start < 10; ++start) {
      PolygonMesh mesh;
      mesh.positions = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0},
                        {3, 3, 0}, {3, 7, 0},  {7, 7, 0},   {7, 3, 0}};
      std::vector<Index> ring = {0, 1, 2, 3, 0};
      const std::array<std::array<Index, 2>, 4> ends = {{{0, 4}, {1, 7}, {2, 6}, {3, 5}}};
      const auto [outer, inner] = ends[static_cast<std::size_t>(bridge)];
      ring.clear();
      for (Index k = 0; k <= 4; ++k) {
        ring.push_back((outer + k) % 4);
      }
      for (Index k = 0; k <= 4; ++k) {
        ring.push_back(4 + (inner - 4 + k) % 4);
      }
      std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start), ring.end());
      mesh.add_face(ring);
      EXPECT_EQ(signed_area_from_above(mesh), (std::pair<double, int>{84, 0}))
          << "bridge " << bridge << ", start " << start;
    }
  }
}

TEST(Triangulate, LeavesTwoHolesOfOneOutlineOpen) {
  PolygonMesh mesh = single_face({{0, 0, 0},
                                  {9, 0, 0},
                                  {9, 3, 0},
                                  {0, 3, 0},
                                  {1, 1, 0},
                                  {1, 2, 0},
                                  {2, 2, 0},
                                  {2, 1, 0},
                                  {5, 1, 0},
                                  {5, 2, 0},
                                  {6, 2, 0},
                                  {6, 1, 0}});
  PolygonMesh keyhole;
  keyhole.positions = mesh.positions;
  keyhole.add_face({0, 1, 2, 3, 0, 4, 5, 6, 7, 8, 9, 10, 11, 8, 7, 4});
  EXPECT_EQ(signed_area_from_above(keyhole), (std::pair<double, int>{25, 0}));
}

TEST(Triangulate, KeepsTheEndOfACrack) {
  // The square's side is left for its middle and come back to: 0 1 (4) 1 2 3.
  PolygonMesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
  mesh.add_face({0, 1, 4, 1, 2, 3});
  EXPECT_EQ(signed_area_from_above(mesh), (std::pair<double, int>{4, 0}));
}

TEST(Triangulate, CutsStarsOfAnySizeAndPlace) {
  for (const double scale : {1e-9, 1.0, 1e6}) {
    for (std::size_t points = 3; points < 40; points += 4) {
      std::vector<Vec3> corners;
      double expected = 0;
      for (std::size_t i = 0; i < 2 * points; ++i) {
        const double angle =
            std::numbers::pi * static_cast<double>(i) / static_cast<double>(points);
        const double radius = scale * (i % 2 == 0 ? 1.0 : 0.3);
        corners.emplace_back(Vec3(std::cos(angle), std::sin(angle), 0) * radius);
      }
      for (std::size_t i = 0; i < corners.size(); ++i) {
        expected += corners[i].cross(corners[(i + 1) % corners.size()]).z() / 2;
      }
      const auto [area, turned] = signed_area_from_above(single_face(corners));
      EXPECT_NEAR(area / expected, 1, 1e-12);
      EXPECT_EQ(turned, 0);
    }
  }
}

TEST(Triangulate, CutsACircleOfManyCornersInNoTime) {
  std::vector<Vec3> corners;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    corners.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  const auto [area, turned] = signed_area_from_above(single_face(corners));
  EXPECT_NEAR(area, std::numbers::pi, 1e-6);
  EXPECT_EQ(turned, 0);
}

TEST(ConcaveCorner, IsThatWhichTurnsTheOtherWay) {
  const PolygonMesh arrow = single_face({{0, 0, 0}, {1, 0.9, 0}, {2, 0, 0}, {1, 2, 0}});
  EXPECT_EQ(concave_corner(arrow.positions, arrow.face(0)), 1U);
  const PolygonMesh square = single_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_EQ(concave_corner(square.positions, square.face(0)), std::nullopt);
  const PolygonMesh straight = single_face({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(concave_corner(straight.positions, straight.face(0)), std::nullopt);
}

TEST(Triangulate, LeavesTrianglesAlone) {
  const TriangleMesh torus = make_torus(0.3, 12, 8);
  EXPECT_EQ(to_triangle_mesh(PolygonMesh(torus)).triangles, torus.triangles);
}

} // namespace
} // namespace cagewright
