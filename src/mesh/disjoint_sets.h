/// \file
/// Sets of vertices, corners or pieces that hang together.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace cagewright {

/// Disjoint sets of the numbers 0 to count - 1, at first each on its own, named by their smallest
/// member whatever the order of joining. Cost: nearly constant for each call.
class DisjointSets {
public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  /// The smallest member of the set of i.
  Index find(Index i) {
    while (parent_[i] != i) {
      i = parent_[i] = parent_[parent_[i]];
    }
    return i;
  }

  /// Makes one set of two; false if they are one already.
  bool join(Index a, Index b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

  void join(const Triangle& t) {
    join(t[0], t[1]);
    join(t[0], t[2]);
  }

private:
  std::vector<Index> parent_;
};

} // namespace cagewright
