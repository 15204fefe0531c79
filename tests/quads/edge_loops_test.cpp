#include "quads/edge_loops.h"

#include "mesh/shapes.h"
#include "mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright {
namespace {

/// The mesh without one of its faces.
PolygonMesh without_face(const PolygonMesh& mesh, std::size_t gone) {
  PolygonMesh open;
  open.positions = mesh.positions;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (f != gone) {
      open.add_face(mesh.face(f));
    }
  }
  return open;
}

std::vector<Vec3> middles(const PolygonMesh& mesh, const QuadStrip& strip) {
  std::vector<Vec3> places;
  for (const auto& [a, b] : strip.rungs) {
    places.emplace_back((mesh.positions[a] + mesh.positions[b]) / 2);
  }
  return places;
}

TEST(EdgeLoops, OfACubeAreThreeStripsOfFourQuads) {
  const std::vector<QuadStrip> strips = strips_of(make_quad_cube());
  ASSERT_EQ(strips.size(), 3U);
  for (const QuadStrip& strip : strips) {
    EXPECT_TRUE(strip.closed);
    EXPECT_EQ(strip.faces.size(), 4U);
    EXPECT_EQ(strip.rungs.size(), 4U);
  }
}

TEST(EdgeLoops, RunFromBorderToBorderOfAnOpenCube) {
  const std::vector<QuadStrip> strips = strips_of(without_face(make_quad_cube(), 0));
  ASSERT_EQ(strips.size(), 3U);
  EXPECT_EQ(std::ranges::count_if(strips, &QuadStrip::closed), 1);
  for (const QuadStrip& strip : strips) {
    EXPECT_EQ(strip.rungs.size(), strip.faces.size() + (strip.closed ? 0 : 1));
  }
}

TEST(EdgeLoops, PutInAndTakenOutLeaveTheCubeAsItWas) {
  const PolygonMesh cube = make_quad_cube();
  for (const QuadStrip& strip : strips_of(cube)) {
    EXPECT_EQ(closed_loops(cube), 0U); // three faces meet at every corner
    const PolygonMesh more = split_strip(cube, strip);
    EXPECT_EQ(more.positions.size(), 12U);
    EXPECT_EQ(more.face_count(), 10U);
    EXPECT_TRUE(topology(more).is_closed());
    EXPECT_EQ(closed_loops(more), 1U);
    std::size_t cubes = 0;
    for (const QuadStrip& other : strips_of(more)) {
      std::vector<Index> drawn;
      const auto less = collapse_strip(more, other, middles(more, other), drawn);
      ASSERT_TRUE(less || other.faces.size() == 6);
      if (less && less->positions.size() == 8) {
        ++cubes;
        EXPECT_EQ(less->face_count(), 6U);
        EXPECT_TRUE(topology(*less).is_closed());
        ASSERT_EQ(drawn.size(), other.rungs.size());
        EXPECT_EQ(less->positions[drawn[0]], middles(more, other)[0]);
      }
    }
    EXPECT_EQ(cubes, 2U); // either half of the strip that was split
  }
}

TEST(EdgeLoops, CannotBeTakenOutWhereNothingIsLeftBetween) {
  const PolygonMesh cube = make_quad_cube();
  for (const QuadStrip& strip : strips_of(cube)) {
    std::vector<Index> drawn;
    EXPECT_FALSE(collapse_strip(cube, strip, middles(cube, strip), drawn));
  }
}

} // namespace
} // namespace cagewright
