#include "quads/matching.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <set>

namespace cagewright {
namespace {

/// By trying all.
std::size_t most(std::span<const PossiblePair> possible, std::set<Index> taken) {
  if (possible.empty()) {
    return 0;
  }
  const PossiblePair& pair = possible.front();
  std::size_t best = most(possible.subspan(1), taken);
  if (taken.insert(pair.first).second && taken.insert(pair.second).second) {
    best = std::max(best, 1 + most(possible.subspan(1), taken));
  }
  return best;
}

TEST(MostPairs, AreDisjointAndAsManyAsTryingAllGives) {
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    const std::size_t nodes = 3 + random.below(7);
    std::vector<PossiblePair> possible;
    for (Index a = 0; a < nodes; ++a) {
      for (Index b = 0; b < a; ++b) {
        if (random.below(100) < 35) {
          possible.push_back({a, b, random.uniform()});
        }
      }
    }
    std::set<Index> taken;
    const std::vector<std::size_t> pairs = most_pairs(nodes, possible);
    for (const std::size_t i : pairs) {
      EXPECT_TRUE(taken.insert(possible[i].first).second);
      EXPECT_TRUE(taken.insert(possible[i].second).second);
    }
    EXPECT_EQ(pairs.size(), most(possible, {}));
  }
}

TEST(MostPairs, AreTheCheaperOnesWhereThatCostsNoPair) {
  const std::vector<PossiblePair> ring = {{0, 1, 5}, {1, 2, 1}, {2, 3, 5}, {3, 0, 1}};
  EXPECT_EQ(most_pairs(4, ring), (std::vector<std::size_t>{1, 3}));
}

TEST(MostPairs, PreferAnExpensivePairToNone) {
  const std::vector<PossiblePair> path = {{0, 1, 9}, {1, 2, 1}, {2, 3, 9}};
  EXPECT_EQ(most_pairs(4, path), (std::vector<std::size_t>{0, 2}));
}

} // namespace
} // namespace cagewright
