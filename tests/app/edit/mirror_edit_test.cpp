#include "app/edit/mirror_edit.h"

#include "app/edit/cage_graph.h"
#include "app/edit/select.h"
#include "core/random.h"
#include "quads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

namespace cagewright::app {
namespace {

Symmetry symmetry_of(const PolygonMesh& cage, double tolerance = 1e-9) {
  return find_partners(cage.positions, Vec3::Zero(), Vec3::UnitX(), tolerance);
}

/// A cube whose vertices are images to the last bit.
PolygonMesh exact_cube(int n) {
  PolygonMesh cube = test::quad_cube(n);
  for (Vec3& p : cube.positions) {
    p = (n * p).array().round() / n;
  }
  return cube;
}

/// To the last bit.
bool is_its_own_image(const PolygonMesh& cage) {
  const Symmetry symmetry = symmetry_of(cage, 1e-12);
  if (!is_mirrored(cage, symmetry)) {
    return false;
  }
  for (Index v = 0; v < cage.positions.size(); ++v) {
    if (cage.positions[symmetry.partner[v]] != symmetry.mirror(cage.positions[v])) {
      return false;
    }
  }
  return true;
}

using Tool = std::function<Result<EditedCage>(const PolygonMesh&, const Selection&)>;

struct NamedTool {
  std::string name;
  SelectionMode mode;
  Tool tool;
  friend void PrintTo(const NamedTool& t, std::ostream* out) { *out << t.name; }
};

class EveryTool : public testing::TestWithParam<NamedTool> {};

TEST_P(EveryTool, LeavesASymmetricCageSymmetricToTheLastBit) {
  const NamedTool& tool = GetParam();
  Random random(7);
  int done = 0;
  for (int round = 0; round < 60; ++round) {
    // An odd number of quads lies across the plane, an even one beside it.
    const PolygonMesh cage = exact_cube(round % 3 == 0 ? 3 : 4);
    const CageGraph graph(cage);
    const Symmetry symmetry = symmetry_of(cage);
    ASSERT_TRUE(is_mirrored(cage, symmetry));
    Selection selection;
    selection.mode = tool.mode;
    if (tool.mode == SelectionMode::face) {
      selection.faces = {static_cast<Index>(random.below(graph.face_count()))};
    } else if (tool.mode == SelectionMode::edge) {
      selection.edges = {graph.edge(static_cast<Index>(random.below(graph.edge_count())))};
    } else {
      selection.vertices = {static_cast<Index>(random.below(graph.vertex_count()))};
    }
    if (random.below(2) == 0) {
      selection = grown(selection, graph);
    }
    double side = 0;
    for (const Index v : vertices_of(selection, graph)) {
      side += cage.positions[v].x();
    }
    Result<EditedCage> edited = tool.tool(cage, mirrored(selection, symmetry.partner, graph, true));
    if (!edited) {
      continue;
    }
    const Result<EditedCage> result = mirrored_edit(cage, symmetry, *std::move(edited), side, 1e-6);
    if (!result) {
      EXPECT_NE(result.error().message.find("alike"), std::string::npos);
      continue;
    }
    ++done;
    EXPECT_TRUE(test::is_sound(result->mesh));
    EXPECT_TRUE(is_its_own_image(result->mesh));
    EXPECT_EQ(result->old_of_new.size(), result->mesh.positions.size());
  }
  EXPECT_GT(done, 10);
}

INSTANTIATE_TEST_SUITE_P(
    MirrorEdit, EveryTool,
    testing::Values(
        NamedTool{"Split", SelectionMode::edge,
                  [](const PolygonMesh& c, const Selection& s) { return split_edges(c, s.edges); }},
        NamedTool{"SplitRing", SelectionMode::edge,
                  [](const PolygonMesh& c, const Selection& s) { return split_rings(c, s.edges); }},
        NamedTool{
            "Collapse", SelectionMode::edge,
            [](const PolygonMesh& c, const Selection& s) { return collapse_edges(c, s.edges); }},
        NamedTool{"Flip", SelectionMode::edge,
                  [](const PolygonMesh& c, const Selection& s) { return flip_edges(c, s.edges); }},
        NamedTool{
            "Subdivide", SelectionMode::face,
            [](const PolygonMesh& c, const Selection& s) { return subdivide_faces(c, s.faces); }},
        NamedTool{"Extrude", SelectionMode::face,
                  [](const PolygonMesh& c, const Selection& s) {
                    return extrude_faces(c, s.faces, 0.3);
                  }},
        NamedTool{"DeleteVertices", SelectionMode::vertex, delete_elements},
        NamedTool{"DeleteEdges", SelectionMode::edge, delete_elements},
        NamedTool{"DeleteFaces", SelectionMode::face, // with the vertices between them
                  [](const PolygonMesh& c, const Selection& s) {
                    return delete_elements(c, grown(s, CageGraph(c)));
                  }}),
    [](const auto& tool) { return tool.param.name; });

TEST(MirrorEdit, DoesTheSameOnTheOtherSideWhereAToolWouldDoOtherwise) {
  // Turned edges go on in the same sense of rotation, which is the opposite one in the image.
  const PolygonMesh cage = test::quad_cube(4);
  const CageGraph graph(cage);
  const Symmetry symmetry = symmetry_of(cage);
  const auto edge = std::find_if(graph.edges().begin(), graph.edges().end(), [&](const auto& e) {
    return cage.positions[e[0]].x() > 0.4 && cage.positions[e[1]].x() > 0.4;
  });
  ASSERT_NE(edge, graph.edges().end());
  Selection selection;
  selection.mode = SelectionMode::edge;
  selection.edges = {*edge};
  const Selection both = mirrored(selection, symmetry.partner, graph, true);
  Result<EditedCage> edited = flip_edges(cage, both.edges);
  ASSERT_TRUE(edited) << edited.error().message;
  EXPECT_FALSE(is_its_own_image(edited->mesh)) << "else this test shows nothing";
  const auto result = mirrored_edit(cage, symmetry, *std::move(edited), 1, 1e-6);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(is_its_own_image(result->mesh));
}

TEST(MirrorEdit, KnowsACageThatIsMirroredInPartsOnly) {
  PolygonMesh cage = test::quad_cube(2);
  EXPECT_TRUE(is_mirrored(cage, symmetry_of(cage)));
  const auto corner = std::find_if(cage.positions.begin(), cage.positions.end(),
                                   [](const Vec3& p) { return p.x() > 0.5; });
  corner->y() += 0.3;
  EXPECT_FALSE(is_mirrored(cage, symmetry_of(cage)));
}

} // namespace
} // namespace cagewright::app
