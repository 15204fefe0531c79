#include "improve/cage_mesh.h"

#include "core/random.h"
#include "mesh/edge_chains.h"
#include "mesh/shapes.h"
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace cagewright {
namespace {

TEST(CageMesh, IsTheSameAfterSplittingAndCollapsing) {
  CageMesh mesh(make_icosphere(1));
  const Patch split = mesh.split(0, mesh.neighbors(0)[0]);
  EXPECT_EQ(split.added.size(), 4);
  mesh.apply(split);
  EXPECT_EQ(mesh.vertex_count(), 43);
  EXPECT_EQ(mesh.face_count(), 82);
  std::optional<Patch> back = mesh.collapse(0, split.vertex);
  ASSERT_TRUE(back);
  back->position = mesh.position(0);
  mesh.apply(*back);
  EXPECT_EQ(mesh.vertex_count(), 42);
  EXPECT_EQ(mesh.face_count(), 80);
  EXPECT_TRUE(is_embedded(mesh.compact()));
}

TEST(CageMesh, StaysClosedThroughCollapses) {
  CageMesh mesh(make_torus(0.4, 12, 8));
  std::size_t collapses = 0;
  for (Index v = 0; v < mesh.vertex_end(); ++v) {
    if (!mesh.has_vertex(v)) {
      continue;
    }
    if (const std::optional<Patch> patch = mesh.collapse(v, mesh.neighbors(v)[0])) {
      mesh.apply(*patch);
      ++collapses;
    }
  }
  EXPECT_GT(collapses, 40);
  const TriangleMesh result = mesh.compact();
  EXPECT_EQ(result.positions.size(), 96 - collapses);
  EXPECT_EQ(result.triangles.size(), 2 * result.positions.size()); // still a torus
  std::set<std::array<Index, 2>> edges;
  for (const Triangle& t : result.triangles) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(edges.insert({t[i], t[(i + 1) % 3]}).second);
    }
  }
  for (const auto& [a, b] : edges) {
    EXPECT_TRUE(edges.contains({b, a}));
  }
}

TEST(CageMesh, RefusesToCollapseATetrahedron) {
  const CageMesh mesh(make_tetrahedron());
  EXPECT_FALSE(mesh.collapse(0, 1));
}

TEST(CageMesh, RefusesToPinchATube) {
  const CageMesh mesh(make_torus(0.4, 3, 3)); // any two vertices are joined round the tube
  std::size_t possible = 0;
  for (Index v = 0; v < mesh.vertex_end(); ++v) {
    for (const Index w : mesh.neighbors(v)) {
      possible += mesh.collapse(v, w) ? 1 : 0;
    }
  }
  EXPECT_EQ(possible, 0);
}

TEST(CageMesh, FlipsThereAndBack) {
  CageMesh mesh(make_icosphere(1));
  const Index a = 0;
  const Index b = mesh.neighbors(0)[0];
  const Index c = mesh.corner_opposite(mesh.face_left_of(a, b), a, b);
  const Index d = mesh.corner_opposite(mesh.face_left_of(b, a), a, b);
  mesh.apply(*mesh.flip(a, b));
  EXPECT_EQ(mesh.face_left_of(a, b), no_index);
  EXPECT_NE(mesh.face_left_of(c, d), no_index);
  mesh.apply(*mesh.flip(c, d));
  EXPECT_NE(mesh.face_left_of(a, b), no_index);
  EXPECT_TRUE(is_embedded(mesh.compact()));
}

TEST(CageMesh, RingsRunRoundTheirVertex) {
  const CageMesh mesh(make_icosphere(2));
  for (Index v = 0; v < mesh.vertex_end(); ++v) {
    const Ring ring = ring_of(mesh.move(v, mesh.position(v)));
    ASSERT_EQ(ring.size(), mesh.around(v).size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      EXPECT_EQ(ring[i][1], ring[(i + 1) % ring.size()][0]);
    }
  }
}

/// A ball with two caps: parts 1 and 2, and 0 between them.
std::vector<Index> caps_of(const TriangleMesh& ball) {
  std::vector<Index> parts;
  for (const Triangle& t : ball.triangles) {
    const double z = (ball.positions[t[0]] + ball.positions[t[1]] + ball.positions[t[2]]).z() / 3;
    parts.push_back(z > 0.4 ? 1 : z < -0.4 ? 2 : 0);
  }
  return parts;
}

std::vector<EdgeChain> seams_of(const CageMesh& mesh) {
  const TriangleMesh compact = mesh.compact();
  PolygonMesh polygons;
  polygons.positions = compact.positions;
  for (const Triangle& t : compact.triangles) {
    polygons.add_face({t[0], t[1], t[2]});
  }
  return chains_of(edges_between_parts(polygons, mesh.compact_parts()));
}

/// Two loops apart from each other, each a cap's border.
void expect_two_seams(const CageMesh& mesh) {
  const std::vector<EdgeChain> seams = seams_of(mesh);
  ASSERT_EQ(seams.size(), 2U);
  for (const EdgeChain& seam : seams) {
    EXPECT_TRUE(seam.closed);
    EXPECT_TRUE(seam.simple);
    EXPECT_GE(seam.vertices.size(), least_seam);
  }
}

TEST(CageMesh, KeepsItsSeamsWhateverIsDoneToIt) {
  const TriangleMesh ball = make_icosphere(2);
  Random random(5);
  for (int run = 0; run < 20; ++run) {
    CageMesh mesh(ball, CageExtent::whole, caps_of(ball));
    std::array<int, 3> made{};
    for (int i = 0; i < 600; ++i) {
      const auto v = static_cast<Index>(random.below(mesh.vertex_end()));
      if (!mesh.has_vertex(v)) {
        continue;
      }
      const std::vector<Index> ends = mesh.neighbors(v);
      const Index w = ends[random.below(ends.size())];
      const std::size_t kind = random.below(8);
      std::optional<Patch> patch = kind == 0   ? std::optional(mesh.split(v, w))
                                   : kind <= 2 ? mesh.flip(v, w)
                                               : mesh.collapse(v, w);
      if (patch) {
        mesh.apply(*patch);
        ++made[kind == 0 ? 0 : kind <= 2 ? 1 : 2];
      }
    }
    EXPECT_GT(*std::min_element(made.begin(), made.end()), 10);
    expect_two_seams(mesh);
  }
}

TEST(CageMesh, CollapsesItsSeamsToFourEdges) {
  const TriangleMesh ball = make_icosphere(2);
  CageMesh mesh(ball, CageExtent::whole, caps_of(ball));
  for (bool any = true; any;) {
    any = false;
    for (Index v = 0; v < mesh.vertex_end(); ++v) {
      const std::vector<Index> ends = mesh.has_vertex(v) ? mesh.neighbors(v) : std::vector<Index>();
      for (const Index w : ends) {
        const std::optional<Patch> patch = mesh.collapse(v, w);
        if (patch) {
          mesh.apply(*patch);
          any = true;
          break;
        }
      }
    }
  }
  expect_two_seams(mesh);
  for (const EdgeChain& seam : seams_of(mesh)) {
    EXPECT_EQ(seam.vertices.size(), least_seam);
  }
  EXPECT_LE(mesh.vertex_count(), 12U);
}

TEST(CageMesh, KnowsTheBandOfASeamAndOfNothingElse) {
  const TriangleMesh ball = make_icosphere(2);
  const std::vector<SeamBand> bands = {{}, {{0, 0, 0.4}, Vec3::UnitZ(), 0.1}, {{0, 0, -0.4}}};
  const CageMesh mesh(ball, CageExtent::whole, caps_of(ball), bands);
  std::size_t on_seams = 0;
  for (Index v = 0; v < mesh.vertex_end(); ++v) {
    if (const SeamBand* band = mesh.band_of(v)) {
      EXPECT_EQ(band->point.z() > 0, mesh.position(v).z() > 0);
      EXPECT_LT(std::abs(std::abs(mesh.position(v).z()) - 0.4), 0.3);
      EXPECT_EQ(mesh.band_of(mesh.move(v, mesh.position(v))), band);
      ++on_seams;
    }
  }
  std::size_t expected = 0;
  for (const EdgeChain& seam : seams_of(mesh)) {
    expected += seam.vertices.size();
    const Index a = seam.vertices[0]; // nothing is gone yet: numbers are the same
    EXPECT_NE(mesh.band_of(mesh.split(a, seam.vertices[1])), nullptr);
  }
  EXPECT_EQ(on_seams, expected);
}

} // namespace
} // namespace cagewright
