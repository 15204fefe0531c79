#include "mesh/shapes.h"
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <vector>

namespace cagewright {
namespace {

PolygonMesh polygon(std::vector<Vec3> positions) {
  PolygonMesh mesh;
  std::vector<Index> face;
  for (Index i = 0; i < positions.size(); ++i) {
    face.push_back(i);
  }
  mesh.positions = std::move(positions);
  mesh.add_face(face);
  return mesh;
}

std::size_t cuttings_of(std::vector<Vec3> positions) {
  const PolygonMesh mesh = polygon(std::move(positions));
  const Triangulation all = every_cutting(mesh);
  EXPECT_EQ(all.triangles.size(), all.face_of.size());
  const std::vector<Triangle> own = triangulate(mesh).triangles;
  EXPECT_TRUE(std::equal(own.begin(), own.end(), all.triangles.begin()));
  return all.triangles.size() - own.size();
}

TEST(EveryCutting, AddsNothingToFlatFacesAndTriangles) {
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 0U);
  EXPECT_EQ(cuttings_of({{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}}), 0U);
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}), 0U);
}

TEST(EveryCutting, CutsBentQuadsAlongBothDiagonalsHoweverLittleTheyAreBent) {
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}), 2U);
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-300}, {0, 1, 0}}), 2U);
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}}), 2U); // concave
}

TEST(EveryCutting, CutsBentPolygonsInAllWays) {
  // Of five corners ten triangles can be made, of six twenty; three and four are there already.
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0.1}}), 7U);
  EXPECT_EQ(cuttings_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0.1}}), 16U);
  std::vector<Vec3> ring;
  for (int i = 0; i < 12; ++i) {
    ring.emplace_back(std::cos(i * 0.5), std::sin(i * 0.5), i == 3 ? 0.1 : 0.0);
  }
  const std::size_t fans = cuttings_of(ring);
  EXPECT_GE(fans, 12U * 10 / 2 - 10);
  EXPECT_LE(fans, 12U * 10);
}

// A saddle whose middle is above or below, by how it is cut: the judge finds a cage that is
// between.
TEST(EveryCutting, ShowsTheJudgeWhatOneDiagonalHides) {
  const PolygonMesh model = polygon({{-1, -1, 0.5}, {1, -1, -0.5}, {1, 1, 0.5}, {-1, 1, -0.5}});
  // A box round the model with a dent from above, down to z = 0.25: clear of one diagonal alone.
  PolygonMesh cage;
  cage.positions = {{-2, -2, -1}, {2, -2, -1}, {2, 2, -1}, {-2, 2, -1}, {-2, -2, 1},
                    {2, -2, 1},   {2, 2, 1},   {-2, 2, 1}, {0, 0, 0.25}};
  for (const auto& face :
       {std::array<Index, 4>{3, 2, 1, 0}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
    cage.add_face(face);
  }
  for (const auto& face : {std::array<Index, 3>{4, 5, 8}, {5, 6, 8}, {6, 7, 8}, {7, 4, 8}}) {
    cage.add_face(face);
  }
  const std::vector<Triangle> low = {{0, 1, 3}, {1, 2, 3}};
  EXPECT_TRUE(validate_cage(cage, TriangleView{model.positions, low})->valid());
  const Triangulation all = every_cutting(model);
  EXPECT_FALSE(validate_cage(cage, TriangleView{model.positions, all.triangles})->valid());
}

} // namespace
} // namespace cagewright
