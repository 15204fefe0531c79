#include "app/document/wire_edges.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

namespace cagewright::app {
namespace {

/// Calls `act(lower, upper)` for the sides of all polygons.
template <class Act> void for_each_side(const PolygonMesh& mesh, const Act& act) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const auto [a, b] = std::minmax(face[i], face[i + 1 < face.size() ? i + 1 : 0]);
      if (a != b) {
        act(Index{a}, Index{b});
      }
    }
  }
}

} // namespace

std::vector<std::array<Index, 2>> wire_edges(const PolygonMesh& mesh) {
  std::vector<std::size_t> begins(mesh.positions.size() + 1, 0); // of each lower vertex
  for_each_side(mesh, [&](Index a, Index) { ++begins[a + 1]; });
  for (std::size_t v = 1; v < begins.size(); ++v) {
    begins[v] += begins[v - 1];
  }
  std::vector<Index> uppers(begins.back());
  std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
  for_each_side(mesh, [&](Index a, Index b) { uppers[next[a]++] = b; });
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(uppers.size() / 2 + 1);
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    const auto begin = uppers.begin() + static_cast<std::ptrdiff_t>(begins[v]);
    const auto end = uppers.begin() + static_cast<std::ptrdiff_t>(begins[v + 1]);
    std::sort(begin, end);
    for (auto upper = begin; upper != end; ++upper) {
      if (upper == begin || *upper != *std::prev(upper)) {
        edges.push_back({v, *upper});
      }
    }
  }
  return edges;
}

} // namespace cagewright::app
