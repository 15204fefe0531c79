#include "voxel/surface_patches.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace cagewright {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h ^= std::bit_cast<std::uint64_t>(p[k] + 0.0); // -0 and 0 are the same place
    h *= 0x9e3779b97f4a7c15ULL;
    h ^= h >> 32U;
  }
  return h;
}

// For every position the first index at which the same one stands.
std::vector<Index> first_at_position(std::span<const Vec3> positions) {
  const std::size_t slots = std::bit_ceil(2 * positions.size() + 1);
  std::vector<Index> table(slots, none);
  std::vector<Index> first(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::size_t slot = hash(positions[i]) & (slots - 1);
    while (table[slot] != none && positions[table[slot]] != positions[i]) {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] == none) {
      table[slot] = static_cast<Index>(i);
    }
    first[i] = table[slot];
  }
  return first;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

// Items grouped by a key in [0, keys): those of key k are order[begin[k]] .. order[begin[k + 1]-1].
struct Buckets {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> order;
};

template <class Key> Buckets bucket(std::size_t items, std::size_t keys, const Key& key) {
  Buckets b{std::vector<std::uint32_t>(keys + 1, 0), std::vector<std::uint32_t>(items)};
  for (std::size_t i = 0; i < items; ++i) {
    ++b.begin[key(i) + 1];
  }
  for (std::size_t k = 0; k < keys; ++k) {
    b.begin[k + 1] += b.begin[k];
  }
  std::vector<std::uint32_t> at(b.begin.begin(), b.begin.end() - 1);
  for (std::size_t i = 0; i < items; ++i) {
    b.order[at[key(i)]++] = static_cast<std::uint32_t>(i);
  }
  return b;
}

std::vector<Triangle> distinct_triangles(TriangleView mesh) {
  const std::vector<Index> first = first_at_position(mesh.positions);
  std::vector<Triangle> welded;
  welded.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Triangle w = {first[t[0]], first[t[1]], first[t[2]]};
    if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) {
      welded.push_back(w);
    }
  }
  const Buckets by_least = bucket(welded.size(), mesh.positions.size(), [&](std::size_t i) {
    return *std::min_element(welded[i].begin(), welded[i].end());
  });
  std::vector<bool> repeated(welded.size(), false);
  std::vector<std::pair<Triangle, std::uint32_t>> group;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    group.clear();
    for (std::uint32_t i = by_least.begin[v]; i < by_least.begin[v + 1]; ++i) {
      group.emplace_back(sorted(welded[by_least.order[i]]), by_least.order[i]);
    }
    std::sort(group.begin(), group.end());
    for (std::size_t i = 1; i < group.size(); ++i) {
      repeated[group[i].second] = group[i].first == group[i - 1].first;
    }
  }
  std::vector<Triangle> kept;
  kept.reserve(welded.size());
  for (std::size_t i = 0; i < welded.size(); ++i) {
    if (!repeated[i]) {
      kept.push_back(welded[i]);
    }
  }
  return kept;
}

// Half-edge h is side h % 3 of triangle h / 3, from its corner h % 3 to the next.
struct HalfEdges {
  const std::vector<Triangle>& triangles;
  [[nodiscard]] Index from(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
  [[nodiscard]] Index to(std::uint32_t h) const { return triangles[h / 3][(h + 1) % 3]; }
};

// For every half-edge the one of the other triangle at the same edge, or none if there is no other
// or more than one.
std::vector<std::uint32_t> partners(const std::vector<Triangle>& triangles, std::size_t vertices) {
  const HalfEdges edges{triangles};
  const auto ends = [&](std::uint32_t h) { return std::minmax({edges.from(h), edges.to(h)}); };
  const Buckets by_least = bucket(3 * triangles.size(), vertices, [&](std::size_t h) {
    return ends(static_cast<std::uint32_t>(h)).first;
  });
  std::vector<std::uint32_t> partner(3 * triangles.size(), none);
  std::vector<std::pair<Index, std::uint32_t>> group;
  for (std::size_t v = 0; v < vertices; ++v) {
    group.clear();
    for (std::uint32_t i = by_least.begin[v]; i < by_least.begin[v + 1]; ++i) {
      group.emplace_back(ends(by_least.order[i]).second, by_least.order[i]);
    }
    std::sort(group.begin(), group.end());
    for (std::size_t i = 0, next = 0; i < group.size(); i = next) {
      while (next < group.size() && group[next].first == group[i].first) {
        ++next;
      }
      if (next - i == 2) {
        partner[group[i].second] = group[i + 1].second;
        partner[group[i + 1].second] = group[i].second;
      }
    }
  }
  return partner;
}

class PatchBuilder {
public:
  PatchBuilder(TriangleView mesh, SurfacePatches& result)
      : positions_(mesh.positions), result_(result), turned_(result.triangles.size(), 0),
        partner_(partners(result.triangles, mesh.positions.size())) {
    result_.patch.assign(result.triangles.size(), -1);
  }

  void run() {
    for (std::uint32_t seed = 0; seed < result_.triangles.size(); ++seed) {
      if (result_.patch[seed] < 0) {
        grow_from(seed);
      }
    }
  }

private:
  void grow_from(std::uint32_t seed) {
    const auto id = static_cast<std::int32_t>(result_.closed.size());
    const HalfEdges edges{result_.triangles};
    bool closed = true;
    members_.assign(1, seed);
    result_.patch[seed] = id;
    for (std::size_t head = 0; head < members_.size(); ++head) {
      const std::uint32_t t = members_[head];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t other = partner_[h];
        if (other == none) {
          closed = false;
          continue;
        }
        const bool alike = edges.from(h) != edges.from(other); // opposite ways: they agree
        const auto wanted = static_cast<char>(alike ? turned_[t] : !turned_[t]);
        if (result_.patch[other / 3] < 0) {
          result_.patch[other / 3] = id;
          turned_[other / 3] = wanted;
          members_.push_back(other / 3);
        } else if (turned_[other / 3] != wanted) {
          closed = false; // a Moebius strip: no orientation is right
        }
      }
    }
    result_.closed.push_back(closed);
    turn_members(closed);
  }

  void turn_members(bool closed) {
    const auto turned = static_cast<std::size_t>(
        std::count_if(members_.begin(), members_.end(), [&](auto t) { return turned_[t]; }));
    const bool swap = 2 * turned > members_.size();
    for (const std::uint32_t t : members_) {
      if (static_cast<bool>(turned_[t]) != swap) {
        std::swap(result_.triangles[t][1], result_.triangles[t][2]);
      }
    }
    if (closed && volume() < 0) {
      for (const std::uint32_t t : members_) {
        std::swap(result_.triangles[t][1], result_.triangles[t][2]);
      }
    }
  }

  [[nodiscard]] double volume() const {
    const Vec3 origin = positions_[result_.triangles[members_[0]][0]];
    double sum = 0;
    for (const std::uint32_t t : members_) {
      const auto [a, b, c] = result_.triangles[t];
      sum += (positions_[a] - origin).dot((positions_[b] - origin).cross(positions_[c] - origin));
    }
    return sum;
  }

  std::span<const Vec3> positions_;
  SurfacePatches& result_;
  std::vector<char> turned_; // relative to the orientation in the file
  std::vector<std::uint32_t> partner_;
  std::vector<std::uint32_t> members_; // of the patch under way
};

} // namespace

bool SurfacePatches::all_closed() const {
  return std::find(closed.begin(), closed.end(), false) == closed.end();
}

SurfacePatches surface_patches(TriangleView mesh) {
  SurfacePatches result;
  result.triangles = distinct_triangles(mesh);
  PatchBuilder(mesh, result).run();
  return result;
}

} // namespace cagewright
