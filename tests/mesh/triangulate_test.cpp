#include <cagewright/mesh/triangulate.h>

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

#include <numeric>

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

TEST(Triangulate, LeavesTrianglesAlone) {
  const TriangleMesh torus = make_torus(0.3, 12, 8);
  EXPECT_EQ(to_triangle_mesh(PolygonMesh(torus)).triangles, torus.triangles);
}

} // namespace
} // namespace cagewright
