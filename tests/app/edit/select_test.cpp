#include "app/edit/select.h"

#include "core/random.h"
#include "quads.h"

#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright::app {
namespace {

using test::quad_cube;
using test::quad_torus;

Selection vertices(std::vector<Index> list) {
  Selection s;
  s.vertices = std::move(list);
  return s;
}

Selection random_selection(SelectionMode mode, const CageGraph& graph, Random& random) {
  Selection all = select_all(mode, graph);
  const auto drop = [&](const auto&) { return random.uniform() < 0.7; };
  std::erase_if(all.vertices, drop);
  std::erase_if(all.edges, drop);
  std::erase_if(all.faces, drop);
  return all;
}

class SelectionsOf : public testing::TestWithParam<SelectionMode> {};
INSTANTIATE_TEST_SUITE_P(Modes, SelectionsOf,
                         testing::Values(SelectionMode::vertex, SelectionMode::edge,
                                         SelectionMode::face));

TEST_P(SelectionsOf, InvertingTwiceChangesNothing) {
  const CageGraph graph(quad_torus());
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Selection s = random_selection(GetParam(), graph, random);
    EXPECT_EQ(inverted(inverted(s, graph), graph), s);
    EXPECT_EQ(s.size() + inverted(s, graph).size(), select_all(GetParam(), graph).size());
  }
}

TEST_P(SelectionsOf, ShrinkingUndoesGrowingAtMost) {
  const CageGraph graph(quad_torus());
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Selection s = random_selection(GetParam(), graph, random);
    const Selection more = grown(s, graph);
    EXPECT_EQ(combined(more, s, Combine::add), more) << "growing keeps what there was";
    const Selection closed = shrunk(more, graph);
    EXPECT_EQ(combined(closed, s, Combine::add), closed) << "shrinking leaves what was grown from";
    EXPECT_EQ(combined(s, shrunk(s, graph), Combine::add), s) << "shrinking adds nothing";
  }
}

TEST_P(SelectionsOf, ConvertingToSmallerElementsKeepsTheVertices) {
  const CageGraph graph(quad_torus());
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Selection s = random_selection(GetParam(), graph, random);
    const Selection v = converted(s, SelectionMode::vertex, graph);
    EXPECT_EQ(v.vertices, vertices_of(s, graph));
    if (GetParam() != SelectionMode::vertex) {
      const Selection back = converted(v, GetParam(), graph);
      EXPECT_EQ(combined(back, s, Combine::add), back) << "and back to at least what there was";
    }
  }
}

TEST_P(SelectionsOf, TogglingTwiceChangesNothing) {
  const CageGraph graph(quad_torus());
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const Selection a = random_selection(GetParam(), graph, random);
    const Selection b = random_selection(GetParam(), graph, random);
    EXPECT_EQ(combined(combined(a, b, Combine::toggle), b, Combine::toggle), a);
    EXPECT_EQ(combined(combined(a, b, Combine::add), b, Combine::subtract),
              combined(a, b, Combine::subtract));
  }
}

TEST(Select, LinkedTakesTheWholePieceAndNoOther) {
  TriangleMesh two = joined(make_cube(), make_tetrahedron());
  const CageGraph graph{PolygonMesh(two)};
  const Selection cube = linked(vertices({3}), graph);
  EXPECT_EQ(cube.vertices, (std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Select, LoopsAndRingsOfATorusGoRoundBothWays) {
  const PolygonMesh torus = quad_torus(12, 6);
  const CageGraph graph(torus);
  const Index along = *graph.find_edge(0, 6); // from ring to ring
  const Index across = *graph.find_edge(0, 1);
  EXPECT_EQ(edge_loop(along, graph).size(), 12U);
  EXPECT_EQ(edge_loop(across, graph).size(), 6U);
  EXPECT_EQ(edge_ring(along, graph).size(), 6U);
  EXPECT_EQ(edge_ring(across, graph).size(), 12U);
  EXPECT_EQ(face_ring(across, graph).size(), 12U);
}

TEST(Select, LoopsEndWhereStraightOnMeansNothing) {
  const PolygonMesh cube = quad_cube(3); // corners have three edges
  const CageGraph graph(cube);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const std::vector<Index> loop = edge_loop(e, graph);
    std::vector<Index> sorted = loop;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end()) << "each edge once";
    EXPECT_NE(std::find(loop.begin(), loop.end(), e), loop.end());
    // Either round the cube, or along one of its edges.
    EXPECT_TRUE(loop.size() == 12 || loop.size() == 3) << loop.size();
  }
}

TEST(Select, LoopsDoNotDependOnTheEdgeTheyBeginWith) {
  const CageGraph graph(quad_cube(4));
  for (Index e = 0; e < graph.edge_count(); ++e) {
    std::vector<Index> loop = edge_loop(e, graph);
    std::sort(loop.begin(), loop.end());
    for (const Index other : loop) {
      std::vector<Index> same = edge_loop(other, graph);
      std::sort(same.begin(), same.end());
      EXPECT_EQ(same, loop);
    }
  }
}

TEST(Select, MirrorsEveryKindOfElement) {
  const PolygonMesh cube = quad_cube(2);
  const CageGraph graph(cube);
  std::vector<Index> partner;
  for (const Vec3& p : cube.positions) {
    const Vec3 image(-p.x(), p.y(), p.z());
    partner.push_back(static_cast<Index>(
        std::find(cube.positions.begin(), cube.positions.end(), image) - cube.positions.begin()));
  }
  Random random(7);
  for (const SelectionMode mode :
       {SelectionMode::vertex, SelectionMode::edge, SelectionMode::face}) {
    const Selection s = random_selection(mode, graph, random);
    const Selection image = mirrored(s, partner, graph, false);
    EXPECT_EQ(image.size(), s.size());
    EXPECT_EQ(mirrored(image, partner, graph, false), s);
    const Selection both = mirrored(s, partner, graph, true);
    EXPECT_EQ(mirrored(both, partner, graph, true), both);
  }
}

TEST(Select, LeavesOutElementsWithoutImage) {
  const CageGraph graph(quad_cube());
  const std::vector<Index> partner(8, ~Index{0});
  EXPECT_TRUE(mirrored(vertices({0, 1}), partner, graph, false).empty());
}

TEST(Select, CarriesOverWhatStillExists) {
  const PolygonMesh cube = quad_cube();
  const CageGraph graph(cube);
  std::vector<Index> renumbered(8);
  for (Index v = 0; v < 8; ++v) {
    renumbered[v] = 7 - v;
  }
  PolygonMesh other;
  other.positions.resize(8);
  for (std::size_t f = 0; f < cube.face_count(); ++f) {
    std::vector<Index> corners;
    for (const Index v : cube.face(f)) {
      corners.push_back(7 - v);
    }
    other.add_face(corners);
  }
  const CageGraph after(other);
  Selection s;
  s.mode = SelectionMode::face;
  s.faces = {2, 4};
  EXPECT_EQ(carried_over(s, graph, renumbered, after).faces, s.faces);
  renumbered[cube.face(2)[0]] = ~Index{0};
  EXPECT_EQ(carried_over(s, graph, renumbered, after).faces.size(),
            std::count_if(s.faces.begin(), s.faces.end(), [&](Index f) {
              const auto face = cube.face(f);
              return std::find(face.begin(), face.end(), cube.face(2)[0]) == face.end();
            }));
}

} // namespace
} // namespace cagewright::app
