#include "render/smooth_normals.h"

#include "core/parallel.h"
#include "mesh/disjoint_sets.h"
#include "render/edges.h"
#include <cagewright/mesh/measures.h>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace cagewright {
namespace {

/// A side of a triangle: between merged points `low` < `high`; it starts at the corner `corner`
/// (3 * triangle + 0, 1 or 2).
struct Side {
  Index low;
  Index high;
  Index corner;
  bool forward; ///< runs from low to high

  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
  }
  [[nodiscard]] bool same_edge(const Side& other) const {
    return low == other.low && high == other.high;
  }
};

Index next_corner(Index corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

std::vector<Side> sorted_sides(TriangleView mesh) {
  const std::vector<Index> merged = merged_points(mesh.positions);
  std::vector<Side> sides(3 * mesh.triangles.size());
  parallel_for(0, mesh.triangles.size(), 4096, [&](std::size_t t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = merged[mesh.triangles[t][i]];
      const Index b = merged[mesh.triangles[t][(i + 1) % 3]];
      sides[3 * t + i] = {std::min(a, b), std::max(a, b), static_cast<Index>(3 * t + i), a < b};
    }
  });
  tbb::parallel_sort(sides.begin(), sides.end());
  return sides;
}

double angle_at(TriangleView mesh, const Triangle& t, std::size_t i) {
  const Vec3 u = mesh.positions[t[(i + 1) % 3]] - mesh.positions[t[i]];
  const Vec3 v = mesh.positions[t[(i + 2) % 3]] - mesh.positions[t[i]];
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

} // namespace

std::vector<Eigen::Vector3f> smooth_normals(TriangleView mesh, double crease_degrees) {
  const std::size_t count = mesh.triangles.size();
  std::vector<Vec3> flat(count);
  parallel_for(0, count, 4096,
               [&](std::size_t t) { flat[t] = triangle_normal(mesh, mesh.triangles[t]); });

  // Only where exactly two triangles meet, with the same idea of outside, is there a surface.
  const double flattest = std::cos(crease_degrees * std::numbers::pi / 180);
  const std::vector<Side> sides = sorted_sides(mesh);
  DisjointSets sets(3 * count); // of corners that share a normal
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].same_edge(sides[i]);) {
      ++end;
    }
    const Side& a = sides[i];
    const Side& b = sides[end - 1];
    if (end == i + 2 && a.forward != b.forward &&
        flat[a.corner / 3].dot(flat[b.corner / 3]) > flattest) {
      sets.join(a.corner, next_corner(b.corner));
      sets.join(next_corner(a.corner), b.corner);
    }
  }

  std::vector<Vec3> sums(3 * count, Vec3::Zero());
  for (std::size_t c = 0; c < 3 * count; ++c) {
    sums[sets.find(static_cast<Index>(c))] +=
        angle_at(mesh, mesh.triangles[c / 3], c % 3) * flat[c / 3];
  }
  std::vector<Eigen::Vector3f> normals(3 * count);
  for (std::size_t c = 0; c < 3 * count; ++c) {
    normals[c] = sums[sets.find(static_cast<Index>(c))].stableNormalized().cast<float>();
  }
  return normals;
}

} // namespace cagewright
