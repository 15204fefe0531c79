#include "symmetry/surface_distances.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <utility>

namespace cagewright {
namespace {

constexpr double far = std::numeric_limits<double>::infinity();

/// The distance of c, given those of a and b; infinite if the front does not come between them.
double across(const Vec3& a, const Vec3& b, const Vec3& c, double at_a, double at_b) {
  const double length = (b - a).norm();
  if (!(length > 0)) {
    return far;
  }
  const Vec3 along = (b - a) / length;
  const double x = along.dot(c - a);
  const double y = (c - a - x * along).norm();
  const double from_x = (at_a * at_a - at_b * at_b + length * length) / (2 * length);
  const double from_y = std::sqrt(std::max(0.0, at_a * at_a - from_x * from_x));
  if (!(y + from_y > 0)) {
    return far;
  }
  const double between = from_x + (x - from_x) * from_y / (from_y + y);
  return between >= 0 && between <= length
             ? std::sqrt((x - from_x) * (x - from_x) + (y + from_y) * (y + from_y))
             : far;
}

/// The triangles at each vertex, in order.
std::vector<std::vector<Index>> triangles_at_vertices(TriangleView surface) {
  std::vector<std::vector<Index>> at(surface.positions.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const Index v : surface.triangles[t]) {
      at[v].push_back(static_cast<Index>(t));
    }
  }
  return at;
}

void march(TriangleView surface, const std::vector<std::vector<Index>>& triangles_at, Index source,
           std::span<double> distances) {
  std::fill(distances.begin(), distances.end(), far);
  std::vector<char> is_done(distances.size(), 0);
  using Front = std::pair<double, Index>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
  distances[source] = 0;
  front.emplace(0, source);
  const auto offer = [&](Index v, double distance) {
    if (distance < distances[v]) {
      distances[v] = distance;
      front.emplace(distance, v);
    }
  };
  const auto& at = surface.positions;
  while (!front.empty()) {
    const auto [distance, v] = front.top();
    front.pop();
    if (is_done[v] != 0) {
      continue;
    }
    is_done[v] = 1;
    for (const Index t : triangles_at[v]) {
      const Triangle& corners = surface.triangles[t];
      for (const Index ahead : corners) {
        if (ahead == v) {
          continue;
        }
        offer(ahead, distance + (at[ahead] - at[v]).norm());
        const Index third = corners[0] + corners[1] + corners[2] - v - ahead;
        if (is_done[ahead] != 0 && is_done[third] == 0) {
          offer(third, across(at[v], at[ahead], at[third], distance, distances[ahead]));
        }
      }
    }
  }
}

} // namespace

SurfaceDistances::SurfaceDistances(TriangleView surface, const Progress& progress)
    : count_(surface.positions.size()), table_(count_ * count_, far) {
  const auto triangles_at = triangles_at_vertices(surface);
  parallel_for(0, count_, 8, progress.quiet(), [&](std::size_t v) {
    march(surface, triangles_at, static_cast<Index>(v),
          std::span(table_).subspan(v * count_, count_));
  });
}

} // namespace cagewright
