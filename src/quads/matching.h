/// \file
/// Pairs out of a graph.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// Two nodes that may become a pair, and what the pair costs.
struct PossiblePair {
  Index first = 0;
  Index second = 0;
  double cost = 0;
};

/// Disjoint pairs, as many as there can be: indices into `possible`, ascending. They are the
/// cheapest ones first, and then as few of these exchanged as augmenting paths need (Edmonds,
/// "Paths, Trees, and Flowers", 1965, by Boost): the sum of the costs is low, but not always the
/// lowest. (The exact one takes a second for 800 nodes.)
///
/// \param nodes N; every index in `possible` is below it, and no pair is listed twice
std::vector<std::size_t> most_pairs(std::size_t nodes, std::span<const PossiblePair> possible);

} // namespace cagewright
