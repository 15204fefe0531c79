#include "voxel/bridge.h"

#include "mesh/disjoint_sets.h"
#include "voxel/grid_components.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <tuple>

namespace cagewright {
namespace {

constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

// For every voxel the nearest occupied one, in steps from face to face.
struct NearestOccupied {
  std::vector<std::size_t> source;
  std::vector<std::int32_t> distance;
};

template <class Visit>
void for_each_face_neighbor(const VoxelGrid& grid, std::size_t i, const Visit& visit) {
  const std::array<int, 3> c = grid.cell(i);
  for (int axis = 0; axis < 3; ++axis) {
    if (c[axis] > 0) {
      visit(i - grid.stride(axis));
    }
    if (c[axis] + 1 < grid.dims[axis]) {
      visit(i + grid.stride(axis));
    }
  }
}

NearestOccupied nearest_occupied(const VoxelGrid& grid) {
  const std::size_t n = grid.kinds.size();
  NearestOccupied nearest{std::vector<std::size_t>(n, nowhere), std::vector<std::int32_t>(n, 0)};
  std::vector<std::size_t> queue;
  for (std::size_t i = 0; i < n; ++i) {
    if (grid.occupied(i)) {
      nearest.source[i] = i;
      queue.push_back(i);
    }
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::size_t at = queue[head];
    for_each_face_neighbor(grid, at, [&](std::size_t next) {
      if (nearest.source[next] == nowhere) {
        nearest.source[next] = nearest.source[at];
        nearest.distance[next] = nearest.distance[at] + 1;
        queue.push_back(next);
      }
    });
  }
  return nearest;
}

struct Link {
  std::int32_t length;
  std::size_t from;
  std::size_t to;
  bool operator<(const Link& other) const {
    return std::tie(length, from, to) < std::tie(other.length, other.from, other.to);
  }
};

// Wherever the zones of two pieces touch. Among these are the edges of a minimum spanning tree
// (Mehlhorn 1988), since the way between two nearest pieces never enters a third one's zone.
std::vector<Link> links_between_zones(const VoxelGrid& grid, const GridComponents& pieces) {
  const NearestOccupied nearest = nearest_occupied(grid);
  std::vector<Link> links;
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const std::array<int, 3> c = grid.cell(i);
    for (int axis = 0; axis < 3; ++axis) {
      if (c[axis] + 1 == grid.dims[axis]) {
        continue;
      }
      const std::size_t next = i + grid.stride(axis);
      const std::size_t from = nearest.source[i];
      const std::size_t to = nearest.source[next];
      if (pieces.labels[from] != pieces.labels[to]) {
        links.push_back({nearest.distance[i] + nearest.distance[next] + 1, std::min(from, to),
                         std::max(from, to)});
      }
    }
  }
  std::sort(links.begin(), links.end());
  return links;
}

// The voxels along the straight line between two centers, each sharing a face with the next.
void mark_line(VoxelGrid& grid, std::size_t from, std::size_t to) {
  std::array<int, 3> at = grid.cell(from);
  const std::array<int, 3> end = grid.cell(to);
  const std::array<int, 3> start = at;
  while (at != end) {
    // Of the axes still to go, the one whose next boundary the line crosses first.
    int axis = -1;
    double soonest = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
      if (at[a] != end[a]) {
        const double when = (std::abs(at[a] - start[a]) + 0.5) / std::abs(end[a] - start[a]);
        if (when < soonest) {
          soonest = when;
          axis = a;
        }
      }
    }
    at[axis] += end[axis] > at[axis] ? 1 : -1;
    VoxelKind& kind = grid.kinds[grid.index(at)];
    if (kind == VoxelKind::outer) {
      kind = VoxelKind::feature;
    }
  }
}

} // namespace

int join_pieces(VoxelGrid& grid) {
  const GridComponents pieces = grid_components(grid);
  if (pieces.count < 2) {
    return 0;
  }
  DisjointSets joined(static_cast<std::size_t>(pieces.count));
  int bridges = 0;
  for (const Link& link : links_between_zones(grid, pieces)) {
    if (joined.join(static_cast<Index>(pieces.labels[link.from]),
                    static_cast<Index>(pieces.labels[link.to]))) {
      mark_line(grid, link.from, link.to);
      ++bridges;
    }
  }
  return bridges;
}

} // namespace cagewright
