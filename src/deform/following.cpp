#include <cagewright/deform/following.h>

#include "core/parallel.h"
#include "deform/some_points.h"
#include "spatial/bvh.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr double high_part = 0.95;
constexpr std::size_t tile_points = 16; // at once, as Coordinates takes them

/// Which columns make up how far a point follows a vertex, and with which factors.
using Influence = std::vector<std::pair<std::size_t, double>>;

std::vector<Influence> influences(const ColumnRule& rule) {
  std::vector<Influence> all(rule.cage_at_rest().size());
  std::vector<double> factors(rule.columns());
  for (std::size_t v = 0; v < all.size(); ++v) {
    std::fill(factors.begin(), factors.end(), 0.0);
    rule.add_influence(static_cast<Index>(v), factors);
    for (std::size_t k = 0; k < factors.size(); ++k) {
      if (factors[k] != 0) {
        all[v].emplace_back(k, factors[k]);
      }
    }
  }
  return all;
}

bool sees(const TriangleBvh& cage, const Vec3& x, const Vec3& vertex) {
  constexpr double ends = 1e-9; // of the segment: the faces that meet there do not count
  const Vec3 way = vertex - x;
  return way.isZero(0) || !cage.first_hit(x + ends * way, way, 1 - 2 * ends);
}

/// How a triangle was stretched, and its area at rest; 0 area: it had none.
struct Stretched {
  double stretch = 1;
  double area = 0;
};

Stretched stretched(const Vec3& u, const Vec3& v, const Vec3& u_now, const Vec3& v_now) {
  const double twice_area = u.cross(v).norm();
  if (!(twice_area > 0)) {
    return {};
  }
  // Singular values s >= t of the map: s^2 + t^2 and s t.
  const double sum = (u_now.squaredNorm() * v.squaredNorm() - 2 * u_now.dot(v_now) * u.dot(v) +
                      v_now.squaredNorm() * u.squaredNorm()) /
                     (twice_area * twice_area);
  const double product = u_now.cross(v_now).norm() / twice_area;
  const double greater =
      (std::sqrt(std::max(sum + 2 * product, 0.0)) + std::sqrt(std::max(sum - 2 * product, 0.0))) /
      2;
  const double less = greater > 0 ? product / greater : 0;
  const double shortened = less > 0 ? 1 / less : std::numeric_limits<double>::infinity();
  return {std::max({greater, shortened, 1.0}), twice_area / 2};
}

/// For each triangle its area vector times the sum of those that share a vertex with it.
std::vector<double> agreement(std::span<const Vec3> positions,
                              std::span<const Triangle> triangles) {
  std::vector<Vec3> areas;
  std::vector<Vec3> round(positions.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3& a = positions[t[0]];
    areas.push_back((positions[t[1]] - a).cross(positions[t[2]] - a));
    for (const Index v : t) {
      round[v] += areas.back();
    }
  }
  std::vector<double> agrees;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Vec3 others = -3 * areas[i];
    for (const Index v : triangles[i]) {
      others += round[v];
    }
    agrees.push_back(areas[i].dot(others));
  }
  return agrees;
}

/// Triangles that touch others when posed and did not at rest. Those that share a corner, or a
/// place at rest as across a seam, are neighbours.
std::size_t count_in_contact(TriangleView rest, std::span<const Vec3> posed) {
  const std::vector<std::pair<Index, Index>> pairs =
      overlapping_pairs(TriangleBvh(TriangleView{posed, rest.triangles}));
  const auto share_corner = [&](const Triangle& a, const Triangle& b) {
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  };
  const auto touch = [&](std::span<const Vec3> at, const Triangle& a, const Triangle& b) {
    const Vec3 first[3] = {at[a[0]], at[a[1]], at[a[2]]};
    const Vec3 second[3] = {at[b[0]], at[b[1]], at[b[2]]};
    return triangle_triangle_distance(first, second) == 0;
  };
  std::vector<std::uint8_t> in_contact(pairs.size(), 0);
  parallel_for(0, pairs.size(), 256, [&](std::size_t i) {
    const Triangle& a = rest.triangles[pairs[i].first];
    const Triangle& b = rest.triangles[pairs[i].second];
    in_contact[i] =
        !share_corner(a, b) && touch(posed, a, b) && !touch(rest.positions, a, b) ? 1 : 0;
  });
  std::vector<std::uint8_t> is_counted(rest.triangles.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (in_contact[i] != 0) {
      is_counted[pairs[i].first] = is_counted[pairs[i].second] = 1;
    }
  }
  return static_cast<std::size_t>(std::count(is_counted.begin(), is_counted.end(), 1));
}

} // namespace

Result<UnseenShare> unseen_share(const PolygonMesh& cage, const Coordinates& coordinates,
                                 std::span<const Vec3> points, const Progress& progress) {
  const TriangleMesh triangles = to_triangle_mesh(cage);
  const TriangleBvh bvh{TriangleView(triangles)};
  const std::vector<Influence> of_vertex = influences(*coordinates.rule());
  const std::vector<Vec3> some = some_points(points);
  std::vector<double> shares(some.size(), -1); // -1: no weights
  const std::size_t tiles = (some.size() + tile_points - 1) / tile_points;
  parallel_for(0, tiles, 1, [&](std::size_t tile) {
    if (progress.cancelled()) {
      return;
    }
    const std::size_t first = tile * tile_points;
    const auto here = std::span(some).subspan(first, std::min(tile_points, some.size() - first));
    AlignedBuffer<double> weights(tile_points * coordinates.columns());
    coordinates.solve(here, weights.span());
    for (std::size_t i = 0; i < here.size(); ++i) {
      double all = 0;
      double unseen = 0;
      for (std::size_t v = 0; v < of_vertex.size(); ++v) {
        double weight = 0;
        for (const auto& [column, factor] : of_vertex[v]) {
          weight += factor * weights.span()[column * tile_points + i];
        }
        all += std::abs(weight);
        unseen += weight != 0 && !sees(bvh, here[i], cage.positions[v]) ? std::abs(weight) : 0;
      }
      shares[first + i] = all > 0 ? unseen / all : -1;
    }
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  std::erase_if(shares, [](double share) { return share < 0; });
  UnseenShare result;
  result.points = shares.size();
  if (!shares.empty()) {
    for (const double share : shares) {
      result.mean += share / static_cast<double>(shares.size());
    }
    std::sort(shares.begin(), shares.end());
    result.high = shares[static_cast<std::size_t>(high_part * static_cast<double>(shares.size()))];
  }
  return result;
}

DeformedFigures deformed_figures(TriangleView rest, std::span<const Vec3> posed) {
  DeformedFigures figures;
  std::vector<Stretched> all;
  double area = 0;
  for (const Triangle& t : rest.triangles) {
    const auto edge = [&](std::span<const Vec3> p, std::size_t k) {
      return Vec3(p[t[k]] - p[t[0]]);
    };
    const Stretched one =
        stretched(edge(rest.positions, 1), edge(rest.positions, 2), edge(posed, 1), edge(posed, 2));
    if (one.area > 0) {
      all.push_back(one);
      area += one.area;
      figures.max_stretch = std::max(figures.max_stretch, one.stretch);
    }
  }
  if (!all.empty()) {
    std::sort(all.begin(), all.end(), [](const Stretched& a, const Stretched& b) {
      return a.stretch != b.stretch ? a.stretch < b.stretch : a.area < b.area;
    });
    figures.mean_stretch = 0;
    double below = 0;
    for (const Stretched& one : all) {
      figures.mean_stretch += one.stretch * (one.area / area);
      if (below < high_part * area) {
        figures.high_stretch = one.stretch;
      }
      below += one.area;
    }
  }
  const double before = signed_volume(rest);
  if (before != 0) {
    figures.volume_change = signed_volume({posed, rest.triangles}) / before - 1;
  }
  const std::vector<double> was = agreement(rest.positions, rest.triangles);
  const std::vector<double> is = agreement(posed, rest.triangles);
  for (std::size_t i = 0; i < was.size(); ++i) {
    figures.flipped += was[i] > 0 && is[i] < 0 ? 1U : 0U;
  }
  figures.in_contact = count_in_contact(rest, posed);
  return figures;
}

} // namespace cagewright
