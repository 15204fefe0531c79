#include "app/edit/edit_cage.h"

#include "app/edit/cage_graph.h"
#include "app/edit/repair_cage.h"
#include "app/edit/select.h"
#include "core/random.h"
#include "mesh/shapes.h"
#include "quads.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright::app {
namespace {

using test::is_sound;
using test::quad_cube;
using test::quad_torus;

double volume(const PolygonMesh& mesh) {
  return signed_volume(to_triangle_mesh(mesh));
}

EdgeVertices random_edge(const PolygonMesh& mesh, Random& random) {
  const CageGraph graph(mesh);
  return graph.edge(static_cast<Index>(random.below(graph.edge_count())));
}

std::vector<Index> random_faces(const PolygonMesh& mesh, Random& random) {
  std::vector<Index> faces;
  for (std::uint64_t n = 1 + random.below(3); n-- > 0;) {
    faces.push_back(static_cast<Index>(random.below(mesh.face_count())));
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

Selection random_selection(const PolygonMesh& mesh, Random& random) {
  Selection s;
  s.mode = static_cast<SelectionMode>(random.below(3));
  if (s.mode == SelectionMode::vertex) {
    s.vertices = {static_cast<Index>(random.below(mesh.positions.size()))};
  } else if (s.mode == SelectionMode::edge) {
    s.edges = {random_edge(mesh, random)};
  } else {
    s.faces = random_faces(mesh, random);
  }
  return s;
}

void expect_maps_agree(const PolygonMesh& before, const EditedCage& after) {
  ASSERT_EQ(after.new_of_old.size(), before.positions.size());
  ASSERT_EQ(after.old_of_new.size(), after.mesh.positions.size());
  for (Index v = 0; v < after.old_of_new.size(); ++v) {
    if (after.old_of_new[v] != EditedCage::none) {
      EXPECT_EQ(after.new_of_old[after.old_of_new[v]], v);
    }
  }
  for (Index v = 0; v < after.new_of_old.size(); ++v) {
    if (after.new_of_old[v] != EditedCage::none) {
      EXPECT_EQ(after.old_of_new[after.new_of_old[v]], v);
    }
  }
}

TEST(EditCage, StaysClosedManifoldAndOrientedWhateverIsDone) {
  Random random(13);
  const std::vector<PolygonMesh> starts = {quad_cube(2), quad_torus(8, 5),
                                           PolygonMesh(make_icosphere(1)),
                                           PolygonMesh(make_tetrahedron())};
  std::array<int, 7> done = {};
  for (const PolygonMesh& start : starts) {
    for (int sequence = 0; sequence < 6; ++sequence) {
      PolygonMesh mesh = start;
      const long genus = *topology(start).genus;
      for (int i = 0; i < 40; ++i) {
        const auto kind = random.below(7);
        const EdgeVertices edge = random_edge(mesh, random);
        const std::vector<Index> faces = random_faces(mesh, random);
        Result<EditedCage> edited = kind == 0   ? split_edges(mesh, std::span(&edge, 1))
                                    : kind == 1 ? collapse_edges(mesh, std::span(&edge, 1))
                                    : kind == 2 ? flip_edges(mesh, std::span(&edge, 1))
                                    : kind == 3 ? subdivide_faces(mesh, faces)
                                    : kind == 4
                                        ? delete_elements(mesh, random_selection(mesh, random))
                                    : kind == 5 ? extrude_faces(mesh, faces, 0.1)
                                                : split_rings(mesh, std::span(&edge, 1));
        if (!edited) {
          EXPECT_FALSE(edited.error().message.empty());
          continue;
        }
        ++done[kind];
        ASSERT_TRUE(is_sound(edited->mesh)) << "after kind " << kind;
        EXPECT_EQ(*topology(edited->mesh).genus, genus);
        expect_maps_agree(mesh, *edited);
        mesh = std::move(edited->mesh);
        if (mesh.face_count() > 300) {
          mesh = start;
        }
      }
    }
  }
  for (const int count : done) {
    EXPECT_GT(count, 20) << "each kind of edit was tried";
  }
}

TEST(EditCage, SplittingAndSubdividingLeaveTheShapeAsItIs) {
  Random random(14);
  for (const PolygonMesh& mesh : {quad_cube(2), PolygonMesh(make_icosphere(1))}) {
    for (int i = 0; i < 30; ++i) {
      const EdgeVertices edge = random_edge(mesh, random);
      for (const Result<EditedCage>& edited :
           {split_edges(mesh, std::span(&edge, 1)), split_rings(mesh, std::span(&edge, 1)),
            subdivide_faces(mesh, random_faces(mesh, random))}) {
        ASSERT_TRUE(edited);
        EXPECT_NEAR(volume(edited->mesh), volume(mesh), 1e-12);
        EXPECT_TRUE(validate_cage(edited->mesh, TriangleView{})->valid())
            << "no three corners on a line";
        EXPECT_GT(edited->mesh.face_count(), mesh.face_count());
      }
    }
  }
}

TEST(EditCage, RingsOfQuadsStayQuads) {
  const PolygonMesh torus = quad_torus(8, 5);
  const EdgeVertices across = {0, 1};
  const Result<EditedCage> edited = split_rings(torus, std::span(&across, 1));
  ASSERT_TRUE(edited);
  EXPECT_EQ(edited->mesh.face_count(), torus.face_count() + 8);
  EXPECT_EQ(edited->mesh.positions.size(), torus.positions.size() + 8);
  for (std::size_t f = 0; f < edited->mesh.face_count(); ++f) {
    EXPECT_EQ(edited->mesh.face(f).size(), 4U);
  }
  EXPECT_EQ(edited->selection.edges.size(), 8U) << "the new loop is selected";
}

TEST(EditCage, SubdividedFacesStayWhatTheyAre) {
  const PolygonMesh cube = quad_cube();
  const std::vector<Index> all = {0, 1, 2, 3, 4, 5};
  const Result<EditedCage> quads = subdivide_faces(cube, all);
  ASSERT_TRUE(quads);
  EXPECT_EQ(quads->mesh.face_count(), 24U);
  EXPECT_EQ(quads->mesh.positions.size(), 26U);
  const PolygonMesh tetrahedron(make_tetrahedron());
  const std::vector<Index> four = {0, 1, 2, 3};
  const Result<EditedCage> triangles = subdivide_faces(tetrahedron, four);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->mesh.face_count(), 16U);
  EXPECT_EQ(triangles->mesh.positions.size(), 10U);
}

TEST(EditCage, FlippingTrianglesTwiceIsTheSameEdgeAgain) {
  const PolygonMesh ball(make_icosphere(1));
  const EdgeVertices edge = CageGraph(ball).edge(10);
  const Result<EditedCage> once = flip_edges(ball, std::span(&edge, 1));
  ASSERT_TRUE(once);
  ASSERT_EQ(once->selection.edges.size(), 1U);
  EXPECT_FALSE(CageGraph(once->mesh).find_edge(edge[0], edge[1]));
  const Result<EditedCage> twice = flip_edges(once->mesh, once->selection.edges);
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->selection.edges[0], edge);
}

TEST(EditCage, RefusesWhatWouldPinchAndSaysWhy) {
  const PolygonMesh tetrahedron(make_tetrahedron());
  const EdgeVertices edge = {0, 1};
  const Result<EditedCage> collapsed = collapse_edges(tetrahedron, std::span(&edge, 1));
  ASSERT_FALSE(collapsed);
  EXPECT_EQ(collapsed.error().code, ErrorCode::invalid_cage);
  EXPECT_FALSE(flip_edges(tetrahedron, std::span(&edge, 1))) << "the other diagonal exists";
  const std::vector<Index> all = {0, 1, 2, 3};
  EXPECT_FALSE(extrude_faces(tetrahedron, all, 0.1));
  EXPECT_FALSE(extrude_faces(tetrahedron, std::span(all).first(1), 0));
  EXPECT_FALSE(delete_elements(tetrahedron, {}));
  const EdgeVertices no_edge = {0, 77};
  EXPECT_FALSE(split_edges(tetrahedron, std::span(&no_edge, 1)));
}

TEST(EditCage, RefusesToWorkOnAnOpenMesh) {
  PolygonMesh open;
  open.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  open.add_face({0, 1, 2});
  const EdgeVertices edge = {0, 1};
  EXPECT_FALSE(split_edges(open, std::span(&edge, 1)));
}

TEST(EditCage, DeletingAVertexTakesJustThatVertex) {
  const PolygonMesh ball(make_icosphere(1));
  Selection s;
  s.vertices = {7, 20};
  const Result<EditedCage> edited = delete_elements(ball, s);
  ASSERT_TRUE(edited);
  EXPECT_EQ(edited->mesh.positions.size(), ball.positions.size() - 2);
  EXPECT_EQ(edited->new_of_old[7], EditedCage::none);
  EXPECT_EQ(edited->new_of_old[20], EditedCage::none);
  EXPECT_EQ(edited->new_of_old[6], 6U);
}

TEST(EditCage, DeletingADiagonalMakesAQuad) {
  const PolygonMesh cube(make_cube());
  Selection s;
  s.mode = SelectionMode::edge;
  const CageGraph graph(cube);
  for (const EdgeVertices& e : graph.edges()) {
    if ((cube.positions[e[0]] - cube.positions[e[1]]).norm() > 2.5) {
      s.edges.push_back(e);
    }
  }
  ASSERT_EQ(s.edges.size(), 6U);
  const Result<EditedCage> edited = delete_elements(cube, s);
  ASSERT_TRUE(edited) << edited.error().message;
  EXPECT_EQ(edited->mesh.face_count(), 6U);
  EXPECT_NEAR(volume(edited->mesh), 8, 1e-12);
}

TEST(EditCage, ExtrudingAddsThePrism) {
  const PolygonMesh cube = quad_cube(2);
  std::vector<Index> top;
  for (Index f = 0; f < cube.face_count(); ++f) {
    const auto face = cube.face(f);
    if (std::all_of(face.begin(), face.end(),
                    [&](Index v) { return cube.positions[v].z() == 1; })) {
      top.push_back(f);
    }
  }
  ASSERT_EQ(top.size(), 4U);
  const Result<EditedCage> edited = extrude_faces(cube, top, 0.5);
  ASSERT_TRUE(edited);
  EXPECT_NEAR(volume(edited->mesh), 8 + 4 * 0.5, 1e-12);
  EXPECT_EQ(edited->mesh.face_count(), cube.face_count() + 8);
  EXPECT_EQ(edited->selection.faces, top) << "what was raised is selected";
  EXPECT_TRUE(validate_cage(edited->mesh, TriangleView{})->valid());
}

TEST(EditCage, KeepsGroups) {
  PolygonMesh cube = quad_cube();
  cube.group_names = {"a", "b"};
  cube.face_groups = {0, 1, 0, 1, 0, 1};
  const std::vector<Index> faces = {1};
  const Result<EditedCage> edited = subdivide_faces(cube, faces);
  ASSERT_TRUE(edited);
  EXPECT_EQ(edited->mesh.group_names, cube.group_names);
  ASSERT_EQ(edited->mesh.face_groups.size(), edited->mesh.face_count());
  EXPECT_GE(std::count(edited->mesh.face_groups.begin(), edited->mesh.face_groups.end(), 1U), 4);
}

TEST(EditCage, LoopsAreCutEvenlyAndSlideToOneSide) {
  const PolygonMesh torus = quad_torus(8, 6);
  const EdgeVertices across = CageGraph(torus).edge(3);
  const std::vector<Index> ring = edge_ring(3, CageGraph(torus));
  for (const int cuts : {1, 2, 5}) {
    for (const double slide : {0.0, 0.7, -0.7}) {
      for (const EdgeVertices& edge : {across, EdgeVertices{across[1], across[0]}}) {
        const Result<EditedCage> edited = cut_loops(torus, edge, cuts, slide);
        ASSERT_TRUE(edited) << edited.error().message;
        expect_maps_agree(torus, *edited);
        EXPECT_TRUE(is_sound(edited->mesh));
        EXPECT_EQ(edited->mesh.positions.size(), torus.positions.size() + cuts * ring.size());
        EXPECT_EQ(edited->mesh.corners().size(), 4 * edited->mesh.face_count()) << "all quads";
        EXPECT_EQ(edited->selection.edges.size(), cuts * ring.size());
        // The first loop is as far along every edge as along this one.
        const Vec3& a = torus.positions[edge[0]];
        const Vec3& b = torus.positions[edge[1]];
        double nearest = 1;
        for (std::size_t v = torus.positions.size(); v < edited->mesh.positions.size(); ++v) {
          const Vec3& p = edited->mesh.positions[v];
          const double t = (p - a).dot(b - a) / (b - a).squaredNorm();
          if ((p - a - t * (b - a)).norm() < 1e-12) {
            nearest = std::min(nearest, t);
          }
        }
        EXPECT_NEAR(nearest, (1 + slide) / (cuts + 1), 1e-12);
      }
    }
  }
  EXPECT_NEAR(volume(cut_loops(torus, across, 3, 0.4)->mesh), volume(torus), 0.05);
}

TEST(EditCage, LoopsEndInTriangles) {
  PolygonMesh cage = quad_cube(2);
  const Result<EditedCage> flipped = split_edges(cage, std::vector{CageGraph(cage).edge(5)});
  ASSERT_TRUE(flipped);
  const CageGraph graph(flipped->mesh);
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const Result<EditedCage> edited = cut_loops(flipped->mesh, graph.edge(e), 3, 0.3);
    ASSERT_TRUE(edited) << edited.error().message;
    EXPECT_TRUE(is_sound(edited->mesh));
    expect_maps_agree(flipped->mesh, *edited);
  }
  EXPECT_FALSE(cut_loops(cage, {0, 1}, 0, 0));
  EXPECT_FALSE(cut_loops(cage, {0, 1}, 1, 1));
  EXPECT_FALSE(cut_loops(cage, {0, 0}, 1, 0));
}

TEST(EditCage, DeletedFacesAreFilledAndStaySelected) {
  const PolygonMesh cube = quad_cube(3);
  const CageGraph graph(cube);
  Selection round; // the four faces round a vertex that only they use
  round.mode = SelectionMode::face;
  for (Index v = 0; v < graph.vertex_count() && round.faces.empty(); ++v) {
    if (graph.vertex_faces(v).size() == 4) {
      round.faces.assign(graph.vertex_faces(v).begin(), graph.vertex_faces(v).end());
    }
  }
  std::ranges::sort(round.faces);
  const Result<EditedCage> edited = delete_elements(cube, round);
  ASSERT_TRUE(edited) << edited.error().message;
  EXPECT_TRUE(is_sound(edited->mesh));
  EXPECT_EQ(edited->mesh.positions.size(), cube.positions.size() - 1);
  EXPECT_EQ(edited->selection.mode, SelectionMode::face);
  EXPECT_FALSE(edited->selection.faces.empty());
  expect_maps_agree(cube, *edited);

  const Selection one{.mode = SelectionMode::face, .vertices = {}, .edges = {}, .faces = {0}};
  const Result<EditedCage> refused = delete_elements(cube, one);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("closed"), std::string::npos);
  Selection all = one;
  for (Index f = 1; f < cube.face_count(); ++f) {
    all.faces.push_back(f);
  }
  EXPECT_FALSE(delete_elements(cube, all));
}

TEST(RepairCage, WeldsAndTurnsWhatIsNearlyRight) {
  const PolygonMesh torus = quad_torus(8, 6);
  PolygonMesh apart;
  Random random(7);
  for (std::size_t f = 0; f < torus.face_count(); ++f) {
    std::vector<Index> corners;
    for (const Index v : torus.face(f)) {
      corners.push_back(static_cast<Index>(apart.positions.size()));
      apart.positions.push_back(torus.positions[v] +
                                1e-7 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0));
    }
    if (random.below(2) == 0) {
      std::ranges::reverse(corners);
    }
    apart.add_face(corners);
  }
  const PolygonMesh good = turned_outward(welded_cage(apart, 1e-5));
  EXPECT_EQ(good.positions.size(), torus.positions.size());
  EXPECT_EQ(good.face_count(), torus.face_count());
  EXPECT_TRUE(is_sound(good));
  EXPECT_NEAR(volume(good), volume(torus), 1e-5);
  EXPECT_EQ(turned_outward(torus).corners().size(), torus.corners().size());
}

} // namespace
} // namespace cagewright::app
