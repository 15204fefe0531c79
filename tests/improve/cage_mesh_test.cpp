#include "improve/cage_mesh.h"

#include "mesh/shapes.h"
#include "validate/validate_cage.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace cagewright
