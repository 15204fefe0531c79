#include "mesh/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace cagewright {
namespace {

TEST(DisjointSets, AreNamedByTheirSmallestMember) {
  DisjointSets sets(6);
  EXPECT_TRUE(sets.join(5, 3));
  EXPECT_TRUE(sets.join(3, 4));
  EXPECT_FALSE(sets.join(4, 5));
  EXPECT_EQ(sets.find(5), 3U);
  EXPECT_TRUE(sets.join(1, 5));
  sets.join(Triangle{0, 2, 0});
  const std::vector<Index> expected = {0, 1, 0, 1, 1, 1};
  for (Index i = 0; i < 6; ++i) {
    EXPECT_EQ(sets.find(i), expected[i]);
  }
}

// Against labels that are all rewritten at every join.
TEST(DisjointSets, AgreeWithLabels) {
  std::mt19937 random(1);
  std::uniform_int_distribution<Index> any(0, 99);
  DisjointSets sets(100);
  std::vector<Index> labels(100);
  std::iota(labels.begin(), labels.end(), Index{0});
  for (int i = 0; i < 120; ++i) {
    const Index a = any(random);
    const Index b = any(random);
    const Index from = std::max(labels[a], labels[b]);
    const Index to = std::min(labels[a], labels[b]);
    EXPECT_EQ(sets.join(a, b), from != to);
    std::ranges::replace(labels, from, to);
    for (Index v = 0; v < 100; ++v) {
      ASSERT_EQ(sets.find(v), labels[v]);
    }
  }
}

} // namespace
} // namespace cagewright
