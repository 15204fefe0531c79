#include "symmetry/limb_tips.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace cagewright {
namespace {

/// What a tip stands out by at least, of the spread of the mean distances.
constexpr double standing_out = 0.06;

/// By area, so that it does not matter where the vertices lie densely.
std::vector<double> mean_distances(TriangleView surface, const SurfaceDistances& distances) {
  std::vector<double> area(surface.positions.size(), 0);
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3& p = surface.positions[a];
    const double twice = (surface.positions[b] - p).cross(surface.positions[c] - p).norm();
    for (const Index v : {a, b, c}) {
      area[v] += twice;
    }
  }
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  std::vector<double> mean(area.size(), 0);
  for (Index v = 0; v < mean.size(); ++v) {
    for (Index u = 0; u < mean.size(); ++u) {
      mean[v] += area[u] / all * distances(v, u);
    }
  }
  return mean;
}

} // namespace

std::vector<Index> limb_tips(TriangleView surface, const SurfaceDistances& distances,
                             std::size_t most) {
  const std::vector<double> height = mean_distances(surface, distances);
  const std::size_t count = height.size();
  if (count == 0) {
    return {};
  }
  std::vector<std::vector<Index>> neighbors(count);
  for (const Triangle& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbors[t[k]].push_back(t[(k + 1) % 3]);
      neighbors[t[(k + 1) % 3]].push_back(t[k]);
    }
  }
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return height[a] != height[b] ? height[a] > height[b] : a < b;
  });
  // As the water falls islands appear, and the lower of two that become one is gone.
  constexpr Index none = std::numeric_limits<Index>::max();
  std::vector<Index> summit(count, none); // of vertices above the water: the way to their summit
  const auto summit_of = [&](Index v) {
    while (summit[v] != v) {
      v = summit[v] = summit[summit[v]];
    }
    return v;
  };
  struct Tip {
    double stands_out = 0;
    Index vertex = 0;
  };
  std::vector<Tip> tips;
  for (const Index v : order) {
    summit[v] = v;
    for (const Index u : neighbors[v]) {
      if (summit[u] == none) {
        continue;
      }
      const Index high = summit_of(v);
      const Index other = summit_of(u);
      if (high == other) {
        continue;
      }
      const bool is_higher =
          height[high] != height[other] ? height[high] > height[other] : high < other;
      const Index gone = is_higher ? other : high;
      tips.push_back({height[gone] - height[v], gone});
      summit[gone] = is_higher ? high : other;
    }
  }
  const double spread = height[order.front()] - height[order.back()];
  tips.push_back({spread, order.front()});
  std::erase_if(tips, [&](const Tip& tip) { return !(tip.stands_out >= standing_out * spread); });
  std::sort(tips.begin(), tips.end(), [](const Tip& a, const Tip& b) {
    return a.stands_out != b.stands_out ? a.stands_out > b.stands_out : a.vertex < b.vertex;
  });
  std::vector<Index> found;
  for (std::size_t i = 0; i < std::min(most, tips.size()); ++i) {
    found.push_back(tips[i].vertex);
  }
  return found;
}

} // namespace cagewright
