#include "app/document/coarse_triangles.h"

#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace cagewright::app {
namespace {

// A surface that crosses a cube leaves about this many triangles in it.
constexpr double triangles_a_cell = 2.5;

/// The number of the cube with the corner at `origin` that p lies in: 21 bits an axis.
std::uint64_t cell_of(const Vec3& p, const Vec3& origin, double size) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = std::floor((p[axis] - origin[axis]) / size);
    key = key << 21U | static_cast<std::uint64_t>(std::clamp(at, 0.0, 2097151.0));
  }
  return key;
}

} // namespace

std::vector<Triangle> coarse_triangles(TriangleView mesh, std::size_t wanted) {
  const double area = surface_area(mesh);
  if (mesh.triangles.size() <= wanted || !(area > 0) || !std::isfinite(area) || wanted == 0) {
    return {};
  }
  const double size = std::sqrt(triangles_a_cell * area / static_cast<double>(wanted));
  const Vec3 origin = bounding_box(mesh.positions).min();
  std::vector<std::pair<std::uint64_t, Index>> order;
  order.reserve(mesh.positions.size());
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    order.emplace_back(cell_of(mesh.positions[v], origin, size), v);
  }
  std::sort(order.begin(), order.end());
  std::vector<Index> instead(mesh.positions.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    Vec3 mean = Vec3::Zero();
    for (; end < order.size() && order[end].first == order[begin].first; ++end) {
      mean += mesh.positions[order[end].second];
    }
    mean /= static_cast<double>(end - begin);
    const auto nearest = std::min_element(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                          order.begin() + static_cast<std::ptrdiff_t>(end),
                                          [&](const auto& a, const auto& b) {
                                            return (mesh.positions[a.second] - mean).squaredNorm() <
                                                   (mesh.positions[b.second] - mean).squaredNorm();
                                          });
    for (std::size_t i = begin; i < end; ++i) {
      instead[order[i].second] = nearest->second;
    }
    begin = end;
  }
  std::vector<std::pair<std::array<Index, 3>, Triangle>> left; // with the corners in order
  for (const Triangle& t : mesh.triangles) {
    const Triangle coarse = {instead[t[0]], instead[t[1]], instead[t[2]]};
    if (coarse[0] != coarse[1] && coarse[1] != coarse[2] && coarse[2] != coarse[0]) {
      std::array<Index, 3> key = {coarse[0], coarse[1], coarse[2]};
      std::sort(key.begin(), key.end());
      left.emplace_back(key, coarse);
    }
  }
  std::stable_sort(left.begin(), left.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Triangle> result;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (i == 0 || left[i].first != left[i - 1].first) {
      result.push_back(left[i].second);
    }
  }
  return result;
}

} // namespace cagewright::app
