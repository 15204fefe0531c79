#include "render/edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace cagewright {
namespace {

auto key(const Vec3& p) {
  return std::make_tuple(p.x(), p.y(), p.z());
}

template <class T> void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
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

std::vector<std::pair<Index, Index>> polygon_edges(const PolygonMesh& mesh) {
  const std::vector<Index> merged = merged_points(mesh.positions);
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(mesh.corners().size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Index a = merged[face[i]];
      const Index b = merged[face[(i + 1) % face.size()]];
      if (a != b) {
        edges.emplace_back(std::minmax(a, b));
      }
    }
  }
  sort_unique(edges);
  return edges;
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
