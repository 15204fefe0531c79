#include "mesh/edge_chains.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright {
namespace {

using Edges = std::vector<std::array<Index, 2>>;

/// A grid of quads, the vertex in column i of row j being number i + j (columns + 1).
PolygonMesh grid(Index columns, Index rows) {
  PolygonMesh mesh;
  for (Index j = 0; j <= rows; ++j) {
    for (Index i = 0; i <= columns; ++i) {
      mesh.positions.emplace_back(i, j, 0);
    }
  }
  for (Index j = 0; j < rows; ++j) {
    for (Index i = 0; i < columns; ++i) {
      const Index a = i + j * (columns + 1);
      mesh.add_face({a, a + 1, a + columns + 2, a + columns + 1});
    }
  }
  return mesh;
}

TEST(EdgeChains, AreLoopsInWhateverOrderTheEdgesAre) {
  const std::vector<EdgeChain> chains = chains_of(Edges{{7, 5}, {1, 2}, {5, 6}, {2, 1}, {6, 7}});
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].vertices, (std::vector<Index>{1, 2}));
  EXPECT_EQ(chains[1].vertices, (std::vector<Index>{5, 6, 7}));
  for (const EdgeChain& chain : chains) {
    EXPECT_TRUE(chain.closed);
    EXPECT_TRUE(chain.simple);
  }
}

TEST(EdgeChains, BeginWhereNoEdgeLeadsTo) {
  const std::vector<EdgeChain> chains = chains_of(Edges{{3, 1}, {1, 2}, {9, 3}, {4, 5}, {5, 4}});
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].vertices, (std::vector<Index>{9, 3, 1, 2}));
  EXPECT_FALSE(chains[0].closed);
  EXPECT_TRUE(chains[0].simple);
  EXPECT_TRUE(chains[1].closed);
}

TEST(EdgeChains, AreNotSimpleWhereTheyTouch) {
  const std::vector<EdgeChain> chains =
      chains_of(Edges{{1, 2}, {2, 3}, {3, 1}, {1, 4}, {4, 5}, {5, 1}});
  std::size_t edges = 0;
  for (const EdgeChain& chain : chains) {
    EXPECT_FALSE(chain.simple);
    EXPECT_TRUE(chain.closed);
    edges += chain.vertices.size();
  }
  EXPECT_EQ(edges, 6U);
}

TEST(EdgesBetweenParts, GoRoundThePartOfTheGreaterNumber) {
  std::vector<Index> parts(9, 0);
  parts[4] = 1; // the face in the middle
  const std::vector<EdgeChain> chains = chains_of(edges_between_parts(grid(3, 3), parts));
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_TRUE(chains[0].closed);
  EXPECT_EQ(chains[0].vertices, (std::vector<Index>{5, 6, 10, 9})); // as the face itself
}

TEST(EdgesBetweenParts, EndAtTheBorder) {
  const std::vector<Index> parts{0, 0, 2, 2};
  const std::vector<EdgeChain> chains = chains_of(edges_between_parts(grid(2, 2), parts));
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_FALSE(chains[0].closed);
  EXPECT_EQ(chains[0].vertices, (std::vector<Index>{3, 4, 5}));
}

TEST(EdgesBetweenParts, AreNoneOfAWhole) {
  EXPECT_TRUE(edges_between_parts(grid(2, 2), std::vector<Index>(4, 7)).empty());
}

} // namespace
} // namespace cagewright
