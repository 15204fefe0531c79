#include "mesh/topology.h"

#include "mesh/shapes.h"
#include "support/models.h"
#include <cagewright/mesh/weld.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <ostream>

namespace cagewright {
namespace {

TEST(Topology, OfASphereIsClosedManifoldAndOfGenusZero) {
  const TopologyReport report = topology(make_icosphere(2));
  EXPECT_TRUE(report.is_closed());
  EXPECT_TRUE(report.is_manifold());
  EXPECT_TRUE(report.is_oriented());
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.edges, 480U);
  EXPECT_EQ(report.genus, 0);
}

TEST(Topology, AddsTheGeneraOfComponents) {
  const TriangleMesh pair = joined(make_torus(0.3, 12, 8), make_torus(0.2, 5, 4));
  const TopologyReport report = topology(joined(pair, make_cube()));
  EXPECT_EQ(report.components, 3U);
  EXPECT_EQ(report.genus, 2);
  EXPECT_EQ(report.component_of_face.front(), 0U);
  EXPECT_EQ(report.component_of_face.back(), 2U);
}

TEST(Topology, FindsTheBoundaryOfAHole) {
  TriangleMesh sphere = make_icosphere(1);
  const Triangle gone = sphere.triangles[5];
  sphere.triangles.erase(sphere.triangles.begin() + 5);
  const TopologyReport report = topology(sphere);
  EXPECT_FALSE(report.is_closed());
  EXPECT_EQ(report.boundary_loops, 1U);
  EXPECT_EQ(report.genus, 0);
  // The neighbors run along the hole's edges against the face that was there.
  std::vector<EdgeVertices> expected = {{gone[1], gone[0]}, {gone[2], gone[1]}, {gone[0], gone[2]}};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(report.boundary_edges, expected);
}

TEST(Topology, FindsAFlippedFaceByItsThreeEdges) {
  TriangleMesh cube = make_cube();
  std::swap(cube.triangles[3][0], cube.triangles[3][1]);
  const TopologyReport report = topology(cube);
  EXPECT_EQ(report.inconsistent_edges.size(), 3U);
  EXPECT_TRUE(report.is_manifold());
  EXPECT_TRUE(report.is_closed());
}

TEST(Topology, FindsAnEdgeOfThreeFaces) {
  TriangleMesh cube = make_cube();
  cube.positions.emplace_back(0, 0, 5);
  cube.triangles.push_back({cube.triangles[0][0], cube.triangles[0][1], 8});
  const TopologyReport report = topology(cube);
  ASSERT_EQ(report.nonmanifold_edges.size(), 1U);
  const auto [low, high] = std::minmax(cube.triangles[0][0], cube.triangles[0][1]);
  EXPECT_EQ(report.nonmanifold_edges[0], (EdgeVertices{low, high}));
  EXPECT_TRUE(report.nonmanifold_vertices.empty());
  EXPECT_FALSE(report.genus.has_value());
}

TEST(Topology, FindsTheVertexWhereTwoConesMeet) {
  const TriangleMesh two = joined(make_tetrahedron(), make_tetrahedron());
  TriangleMesh pinched = two;
  for (Triangle& t : pinched.triangles) {
    std::replace(t.begin(), t.end(), Index{6}, Index{1});
  }
  const TopologyReport report = topology(pinched);
  EXPECT_EQ(report.nonmanifold_vertices, std::vector<Index>{1});
  EXPECT_EQ(report.unused_vertices, std::vector<Index>{6});
  EXPECT_TRUE(report.nonmanifold_edges.empty());
  EXPECT_EQ(report.components, 1U);
  EXPECT_TRUE(topology(two).is_manifold());
}

TEST(Topology, ListsFacesThatRepeatACornerOrAnEarlierFace) {
  TriangleMesh cube = make_cube();
  const Triangle t = cube.triangles[0];
  cube.triangles.push_back({t[0], t[1], t[0]});
  cube.triangles.push_back({t[2], t[1], t[0]});
  const TopologyReport report = topology(cube);
  EXPECT_EQ(report.repeated_corner_faces, std::vector<Index>{12});
  EXPECT_EQ(report.duplicate_faces, std::vector<Index>{13});
}

TEST(Topology, CountsTheSidesOfPolygonsNotTheirDiagonals) {
  const PolygonMesh box = make_quad_cube();
  const TopologyReport report = topology(box);
  EXPECT_EQ(report.edges, 12U);
  EXPECT_TRUE(report.is_closed() && report.is_manifold() && report.is_oriented());
  EXPECT_EQ(report.genus, 0);
}

TEST(Topology, OfNothingIsNotClosed) {
  const TopologyReport report = topology(TriangleMesh());
  EXPECT_FALSE(report.is_closed());
  EXPECT_EQ(report.components, 0U);
}

TEST(Weld, MergesEqualPositionsOnly) {
  const std::vector<Vec3> points = {
      {0, 0, 0}, {1, 2, 3}, {-0.0, 0, 0}, {1, 2, 3}, {1, 2, 3 + 1e-15}};
  const WeldedPoints welded = weld_points(points);
  EXPECT_EQ(welded.point_of, (std::vector<Index>{0, 1, 0, 1, 2}));
  EXPECT_EQ(welded.first_with, (std::vector<Index>{0, 1, 4}));
}

TEST(Weld, LeavesPointsThatAreNotNumbersApart) {
  const Vec3 nan(std::nan(""), 0, 0);
  EXPECT_EQ(weld_points(std::vector<Vec3>{nan, nan}).positions.size(), 2U);
}

TEST(Weld, ClosesASoup) {
  const TriangleMesh sphere = make_icosphere(2);
  TriangleMesh soup;
  for (const Triangle& t : sphere.triangles) {
    const auto first = static_cast<Index>(soup.positions.size());
    for (const Index v : t) {
      soup.positions.push_back(sphere.positions[v]);
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(topology(soup).components, sphere.triangles.size());
  const TopologyReport report = topology(weld(soup));
  EXPECT_EQ(report.components, 1U);
  EXPECT_TRUE(report.is_closed());
}

/// What is known of the packaged models, after welding.
struct Known {
  const char* file;
  std::size_t vertices;
  std::size_t boundary_edges;
  std::size_t boundary_loops;
  std::size_t nonmanifold_vertices;
  std::size_t components;
  std::optional<long> genus;
  const char* packaged_as = file; ///< its name in the Debian package
};

void PrintTo(const Known& known, std::ostream* out) {
  *out << known.file;
}

class TopologyOfModel : public testing::TestWithParam<Known> {};

TEST_P(TopologyOfModel, IsAsPublished) {
  const Known& known = GetParam();
  const auto mesh = test::real_polygons({known.file, known.packaged_as});
  if (!mesh) {
    GTEST_SKIP() << "CAGEWRIGHT_MODELS names no directory with " << known.file;
  }
  const PolygonMesh merged = weld(*mesh);
  const TopologyReport report = topology(merged);
  EXPECT_EQ(merged.positions.size(), known.vertices);
  EXPECT_EQ(report.boundary_edges.size(), known.boundary_edges);
  EXPECT_EQ(report.boundary_loops, known.boundary_loops);
  EXPECT_EQ(report.nonmanifold_edges.size(), 0U);
  EXPECT_EQ(report.nonmanifold_vertices.size(), known.nonmanifold_vertices);
  EXPECT_EQ(report.components, known.components);
  EXPECT_EQ(report.genus, known.genus);
}

INSTANTIATE_TEST_SUITE_P(
    Packaged, TopologyOfModel,
    testing::Values(
        Known{"bunny.obj", 3301, 0, 0, 0, 1, 0}, Known{"cow.off", 2903, 0, 0, 1, 1, {}},
        Known{"spot_quads.obj", 2930, 0, 0, 0, 1, 0}, Known{"teapot.obj", 3241, 160, 6, 1, 3, {}},
        Known{"suzanne.obj", 505, 42, 4, 2, 1, {}}, Known{"rocker-arm.obj", 10044, 0, 0, 0, 1, 1},
        Known{"cheese_g133.off", 8629, 0, 0, 0, 1, 133, "cheese.off"},
        Known{"elephant_holes.off", 2733, 1353, 106, 65, 1, {}, "elephant-with-holes.off"},
        Known{"arm.obj", 2089, 20, 1, 0, 1, 0}, Known{"arm_cage.obj", 58, 0, 0, 0, 1, 0}));

} // namespace
} // namespace cagewright
