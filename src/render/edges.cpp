#include "render/edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

namespace cagewright {
namespace {

auto key(const Vec3& p) {
  return std::make_tuple(p.x(), p.y(), p.z());
}

template <class T> void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// A side of a polygon, between merged points.
struct Side {
  std::pair<Index, Index> edge; ///< the lower index first
  std::size_t face;

  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.edge, a.face) < std::tie(b.edge, b.face);
  }
};

std::vector<Side> sorted_sides(const PolygonMesh& mesh) {
  const std::vector<Index> merged = merged_points(mesh.positions);
  std::vector<Side> sides;
  sides.reserve(mesh.corners().size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Index a = merged[face[i]];
      const Index b = merged[face[(i + 1) % face.size()]];
      if (a != b) {
        sides.push_back({std::minmax(a, b), f});
      }
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Unit normal by Newell's method.
Vec3 polygon_normal(const PolygonMesh& mesh, std::size_t f) {
  const std::span<const Index> face = mesh.face(f);
  const Vec3& origin = mesh.positions[face[0]];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    sum += (mesh.positions[face[i]] - origin).cross(mesh.positions[face[i + 1]] - origin);
  }
  return sum.stableNormalized();
}

} // namespace

std::vector<Index> merged_points(std::span<const Vec3> positions) {
  std::vector<Index> order(positions.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::make_tuple(key(positions[a]), a) < std::make_tuple(key(positions[b]), b);
  });
  std::vector<Index> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

std::vector<std::pair<Index, Index>> polygon_edges(const PolygonMesh& mesh,
                                                   double least_bend_degrees) {
  std::vector<Side> sides = sorted_sides(mesh);
  const double flattest = std::cos(least_bend_degrees * std::numbers::pi / 180);
  std::vector<std::pair<Index, Index>> edges;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i; end < sides.size() && sides[end].edge == sides[i].edge;) {
      ++end;
    }
    const bool flat =
        least_bend_degrees > 0 && end == i + 2 &&
        polygon_normal(mesh, sides[i].face).dot(polygon_normal(mesh, sides[i + 1].face)) > flattest;
    if (!flat) {
      edges.push_back(sides[i].edge);
    }
  }
  return edges;
}

std::vector<Index> end_points(const std::vector<std::pair<Index, Index>>& edges) {
  std::vector<Index> points;
  points.reserve(2 * edges.size());
  for (const auto& [a, b] : edges) {
    points.push_back(a);
    points.push_back(b);
  }
  sort_unique(points);
  return points;
}

std::vector<Index> used_points(const PolygonMesh& mesh) {
  const std::vector<Index> merged = merged_points(mesh.positions);
  std::vector<Index> used;
  used.reserve(mesh.corners().size());
  for (const Index v : mesh.corners()) {
    used.push_back(merged[v]);
  }
  sort_unique(used);
  return used;
}

} // namespace cagewright
