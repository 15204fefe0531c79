#include "voxel/classify.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// Rays do not start at the voxels' centers but this much beside: symmetric models have vertices and
// edges exactly on planes and lines through centers, and a voxel without surface is all alike.
constexpr double beside_u = 0.5381966;
constexpr double beside_v = 0.5236068;

// Where a line along an axis meets a triangle.
struct Crossing {
  double height;
  std::uint32_t line;
  std::uint32_t triangle;
  std::int8_t sign; // +1 where the line leaves the front's inside: normal . direction > 0
};

bool before(const Crossing& a, const Crossing& b) {
  return a.height != b.height ? a.height < b.height : a.triangle < b.triangle;
}

// The lines along `axis` through the voxels' ray origins, numbered u + dims[u] * v.
struct Lines {
  int w, u, v;
  std::array<int, 3> dims;
  Lines(int axis, const std::array<int, 3>& d)
      : w(axis), u((axis + 1) % 3), v((axis + 2) % 3), dims(d) {}
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(dims[u]) * dims[v]; }
};

double orientation(double ax, double ay, double bx, double by, double px, double py) {
  return (bx - ax) * (py - ay) - (by - ay) * (px - ax);
}

// On which side of the directed edge a -> b the point lies, seen along the lines' axis. The sign is
// computed once for both directions, from the lesser to the greater vertex: a line crosses exactly
// one of two triangles that share an edge, whatever the round-off.
double side(const Lines& lines, const std::vector<Vec3>& positions, Index a, Index b, double px,
            double py) {
  const Vec3& low = positions[std::min(a, b)];
  const Vec3& high = positions[std::max(a, b)];
  double s = orientation(low[lines.u], low[lines.v], high[lines.u], high[lines.v], px, py);
  if (s == 0) {
    s = std::numeric_limits<double>::min();
  }
  return a < b ? s : -s;
}

void cross_triangle(const Lines& lines, const std::vector<Vec3>& positions, const Triangle& t,
                    std::uint32_t triangle, std::vector<Crossing>& out) {
  const Vec3& a = positions[t[0]];
  const Vec3& b = positions[t[1]];
  const Vec3& c = positions[t[2]];
  const auto range = [&](int axis, double beside) {
    const double low = std::min({a[axis], b[axis], c[axis]});
    const double high = std::max({a[axis], b[axis], c[axis]});
    return std::pair(static_cast<int>(std::ceil(low - beside)),
                     static_cast<int>(std::floor(high - beside)));
  };
  const auto [u0, u1] = range(lines.u, beside_u);
  const auto [v0, v1] = range(lines.v, beside_v);
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      const double px = u + beside_u;
      const double py = v + beside_v;
      const double sa = side(lines, positions, t[1], t[2], px, py);
      const double sb = side(lines, positions, t[2], t[0], px, py);
      const double sc = side(lines, positions, t[0], t[1], px, py);
      if ((sa > 0) == (sb > 0) && (sb > 0) == (sc > 0)) {
        const double height =
            (sa * a[lines.w] + sb * b[lines.w] + sc * c[lines.w]) / (sa + sb + sc);
        out.push_back({height, static_cast<std::uint32_t>(u + lines.dims[lines.u] * v), triangle,
                       static_cast<std::int8_t>(sa > 0 ? 1 : -1)});
      }
    }
  }
}

// All crossings of the lines along one axis, line by line from below.
struct CrossingTable {
  std::vector<std::size_t> begin; // of each line, and one past the last
  std::vector<Crossing> crossings;
  [[nodiscard]] std::span<const Crossing> line(std::size_t l) const {
    return std::span(crossings).subspan(begin[l], begin[l + 1] - begin[l]);
  }
};

CrossingTable cross_all(const Lines& lines, const std::vector<Vec3>& positions,
                        const std::vector<Triangle>& triangles) {
  const auto found = parallel_reduce_ordered(
      0, triangles.size(), 4096, std::vector<Crossing>(),
      [&](std::size_t first, std::size_t last) {
        std::vector<Crossing> block;
        for (std::size_t t = first; t < last; ++t) {
          cross_triangle(lines, positions, triangles[t], static_cast<std::uint32_t>(t), block);
        }
        return block;
      },
      [](std::vector<Crossing>& all, const std::vector<Crossing>& block) {
        all.insert(all.end(), block.begin(), block.end());
      });
  CrossingTable table{std::vector<std::size_t>(lines.count() + 1, 0),
                      std::vector<Crossing>(found.size())};
  for (const Crossing& c : found) {
    ++table.begin[c.line + 1];
  }
  for (std::size_t l = 0; l < lines.count(); ++l) {
    table.begin[l + 1] += table.begin[l];
  }
  std::vector<std::size_t> at(table.begin.begin(), table.begin.end() - 1);
  for (const Crossing& c : found) {
    table.crossings[at[c.line]++] = c;
  }
  parallel_for(0, lines.count(), 256, [&](std::size_t l) {
    std::sort(table.crossings.begin() + static_cast<std::ptrdiff_t>(table.begin[l]),
              table.crossings.begin() + static_cast<std::ptrdiff_t>(table.begin[l + 1]), before);
  });
  return table;
}

// Turns open patches that show more of their back than of their front to rays from outside, by
// changing the signs of their crossings.
void turn_open_patches(const SurfacePatches& patches, std::array<CrossingTable, 3>& tables) {
  std::vector<std::int64_t> front(patches.closed.size(), 0);
  for (const CrossingTable& table : tables) {
    for (std::size_t l = 0; l + 1 < table.begin.size(); ++l) {
      const auto line = table.line(l);
      if (!line.empty()) {
        front[patches.patch[line.front().triangle]] -= line.front().sign;
        front[patches.patch[line.back().triangle]] += line.back().sign;
      }
    }
  }
  for (CrossingTable& table : tables) {
    for (Crossing& c : table.crossings) {
      const std::int32_t p = patches.patch[c.triangle];
      if (!patches.closed[p] && front[p] < 0) {
        c.sign = static_cast<std::int8_t>(-c.sign);
      }
    }
  }
}

// Adds the two votes of the rays along one axis.
void vote(const Lines& lines, const CrossingTable& table, const VoxelGrid& grid,
          std::vector<std::uint8_t>& votes) {
  parallel_for(0, lines.count(), 256, [&](std::size_t l) {
    const auto crossings = table.line(l);
    if (crossings.empty()) {
      return;
    }
    const auto nu = static_cast<std::size_t>(lines.dims[lines.u]);
    std::size_t at = (l % nu) * grid.stride(lines.u) + (l / nu) * grid.stride(lines.v);
    int ahead = 0; // leaving less entering, above and below
    int behind = 0;
    for (const Crossing& c : crossings) {
      ahead += c.sign;
    }
    std::size_t next = 0;
    for (int k = 0; k < lines.dims[lines.w]; ++k, at += grid.stride(lines.w)) {
      for (; next < crossings.size() && crossings[next].height < k + 0.5; ++next) {
        ahead -= crossings[next].sign;
        behind -= crossings[next].sign;
      }
      votes[at] = static_cast<std::uint8_t>(votes[at] + (ahead > 0) + (behind > 0));
    }
  });
}

std::vector<std::uint8_t> inside_votes(TriangleView mesh, const SurfacePatches& patches,
                                       const VoxelGrid& grid) {
  std::vector<Vec3> positions(mesh.positions.size());
  parallel_for(0, positions.size(), 4096,
               [&](std::size_t i) { positions[i] = grid.to_grid(mesh.positions[i]); });
  std::array<CrossingTable, 3> tables;
  for (int axis = 0; axis < 3; ++axis) {
    tables[axis] = cross_all(Lines(axis, grid.dims), positions, patches.triangles);
  }
  if (!patches.all_closed()) {
    turn_open_patches(patches, tables);
  }
  std::vector<std::uint8_t> votes(grid.kinds.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    vote(Lines(axis, grid.dims), tables[axis], grid, votes);
  }
  return votes;
}

class Regions {
public:
  Regions(VoxelGrid& grid, const std::vector<std::uint8_t>& votes, bool sealed)
      : grid_(grid), votes_(votes), sealed_(sealed), seen_(grid.kinds.size(), false) {}

  void decide() {
    for (std::size_t seed = 0; seed < seen_.size(); ++seed) {
      if (!seen_[seed] && grid_.kinds[seed] != VoxelKind::feature) {
        collect(seed);
        if (!reaches_boundary_) {
          decide_as_a_whole();
        } else if (!sealed_) {
          decide_one_by_one();
        }
      }
    }
  }

private:
  // The region of the seed into region_, and whether it reaches the grid's boundary.
  void collect(std::size_t seed) {
    region_.assign(1, seed);
    seen_[seed] = true;
    reaches_boundary_ = false;
    for (std::size_t head = 0; head < region_.size(); ++head) {
      const std::array<int, 3> c = grid_.cell(region_[head]);
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t stride = grid_.stride(axis);
        if (c[axis] > 0 && c[axis] + 1 < grid_.dims[axis]) {
          enter(region_[head] - stride);
          enter(region_[head] + stride);
        } else {
          reaches_boundary_ = true;
          enter(c[axis] > 0 ? region_[head] - stride : region_[head] + stride);
        }
      }
    }
  }

  void enter(std::size_t i) {
    if (!seen_[i] && grid_.kinds[i] != VoxelKind::feature) {
      seen_[i] = true;
      region_.push_back(i);
    }
  }

  // At this resolution the surface shuts the region off, so that of six votes two on average are
  // enough: those lost are to holes that are narrower than a voxel.
  void decide_as_a_whole() {
    std::uint64_t sum = 0;
    for (const std::size_t i : region_) {
      sum += votes_[i];
    }
    if (sum >= 2 * region_.size()) {
      for (const std::size_t i : region_) {
        grid_.kinds[i] = VoxelKind::inner;
      }
    }
  }

  // Votes are first averaged over neighbours in the region, twice: a wrong ray makes a line of
  // wrong votes, one voxel thin, while the inside near a hole has many agreeing. Only voxels with
  // half the votes can come out inner, and in most regions they are few.
  void decide_one_by_one() {
    std::vector<std::size_t> doubtful;
    std::vector<float> share(grid_.kinds.size(), -1);
    for (const std::size_t i : region_) {
      share[i] = static_cast<float>(votes_[i]) / 6;
      if (votes_[i] >= 3) {
        doubtful.push_back(i);
      }
    }
    share = averaged(averaged(share, with_neighbors(doubtful)), doubtful);
    for (const std::size_t i : doubtful) {
      if (share[i] > 0.6F) {
        grid_.kinds[i] = VoxelKind::inner;
      }
    }
  }

  template <class Visit> void for_each_neighbor(std::size_t i, const Visit& visit) const {
    const std::array<int, 3> c = grid_.cell(i);
    for (int z = std::max(c[2] - 1, 0); z <= std::min(c[2] + 1, grid_.dims[2] - 1); ++z) {
      for (int y = std::max(c[1] - 1, 0); y <= std::min(c[1] + 1, grid_.dims[1] - 1); ++y) {
        for (int x = std::max(c[0] - 1, 0); x <= std::min(c[0] + 1, grid_.dims[0] - 1); ++x) {
          visit(grid_.index(x, y, z));
        }
      }
    }
  }

  [[nodiscard]] std::vector<std::size_t>
  with_neighbors(const std::vector<std::size_t>& voxels) const {
    std::vector<bool> taken(grid_.kinds.size(), false);
    std::vector<std::size_t> result;
    for (const std::size_t i : voxels) {
      for_each_neighbor(i, [&](std::size_t n) {
        if (!taken[n] && grid_.kinds[n] != VoxelKind::feature) {
          taken[n] = true;
          result.push_back(n);
        }
      });
    }
    return result;
  }

  // The mean of the shares of these voxels' neighbours, those of less than 0 left out.
  [[nodiscard]] std::vector<float> averaged(const std::vector<float>& share,
                                            const std::vector<std::size_t>& voxels) const {
    std::vector<float> result(share.size(), -1);
    parallel_for(0, voxels.size(), 1024, [&](std::size_t v) {
      float sum = 0;
      int count = 0;
      for_each_neighbor(voxels[v], [&](std::size_t n) {
        sum += std::max(share[n], 0.0F);
        count += share[n] >= 0;
      });
      result[voxels[v]] = count > 0 ? sum / static_cast<float>(count) : -1;
    });
    return result;
  }

  VoxelGrid& grid_;
  const std::vector<std::uint8_t>& votes_;
  bool sealed_; // no hole in the surface
  std::vector<char> seen_;
  std::vector<std::size_t> region_;
  bool reaches_boundary_ = false;
};

} // namespace

Status classify(TriangleView mesh, VoxelGrid& grid, const Progress& progress) {
  progress(0, "classifying voxels");
  const SurfacePatches patches = surface_patches(mesh);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  return classify(mesh, patches, grid, progress.part(0.5, 1));
}

Status classify(TriangleView mesh, const SurfacePatches& patches, VoxelGrid& grid,
                const Progress& progress) {
  progress(0, "classifying voxels");
  const std::vector<std::uint8_t> votes = inside_votes(mesh, patches, grid);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(0.6, "classifying voxels");
  Regions(grid, votes, patches.all_closed()).decide();
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(1, "classifying voxels");
  return success();
}

} // namespace cagewright
