#include "improve/face_terms.h"

#include <algorithm>
#include <cmath>

namespace cagewright {

namespace {

// Where two points nearly touch, the direction between them means nothing.
constexpr double touching = 0.01; // of the distance to keep

void add_tips(const Objective& objective, const Corners& t, FaceTerms& terms) {
  if (!(objective.tip_weight() > 0)) {
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const SurfaceTree::Nearest near = objective.nearest(t[k]);
    const double beyond = objective.beyond_near(near.distance);
    if (beyond > 0) {
      const Vec3 u = (t[k] - near.point) / near.distance;
      terms.gradient[k] += 2 * objective.tip_weight() * beyond * u;
      terms.hessian[k][k] += 2 * objective.tip_weight() * u * u.transpose();
    }
  }
}

} // namespace

FaceTerms volume_and_gap(const Objective& objective, const Corners& t, const Vec3& origin) {
  FaceTerms terms;
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.norm() / 2;
  if (!(area > 0)) {
    return terms;
  }
  const Vec3 n = normal / (2 * area);
  double mean = 0;
  for (int s = 0; s < 6; ++s) {
    std::array<double, 3> share;
    for (int k = 0; k < 3; ++k) {
      const double spread = s < 3 ? 0.5 : -0.25; // three samples near the corners, three opposite
      share[k] = s % 3 == k ? 1.0 / 3 + 2 * spread / 3 : 1.0 / 3 - spread / 3;
    }
    const Vec3 p = share[0] * t[0] + share[1] * t[1] + share[2] * t[2];
    const SurfaceTree::Nearest near = objective.nearest(p);
    const double d = near.distance;
    mean += objective.gap(near) / 6;
    if (!(d > 0)) {
      continue;
    }
    const Vec3 u = (p - near.point) / d;
    const Mat3 outer = area / 6 * objective.gap_curvature(near) * u * u.transpose();
    for (int k = 0; k < 3; ++k) {
      terms.gradient[k] += area / 6 * share[k] * objective.gap_slope(near) * u;
      for (int m = 0; m < 3; ++m) {
        terms.hessian[k][m] += share[k] * share[m] * outer;
      }
    }
  }
  for (int k = 0; k < 3; ++k) {
    const Vec3& b = t[(k + 1) % 3];
    const Vec3& c = t[(k + 2) % 3];
    const Vec3 area_slope = n.cross(c - b) / 2;
    terms.gradient[k] += (b - origin).cross(c - origin) / 6 + mean * area_slope;
  }
  add_tips(objective, t, terms);
  return terms;
}

void KeepClear::add_triangle(const Triangle& vertices, const Corners& t, int cells,
                             std::vector<BlockConstraint>& constraints) const {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double length = normal.norm();
  if (!(length > 0)) {
    return;
  }
  const Vec3 n = normal / length;
  for (const SurfaceTree::Relief& r : model.relief(t, cells, -(keep + reach), reach)) {
    constraints.push_back(
        {vertices, {1 - r.at_b - r.at_c, r.at_b, r.at_c}, n, std::min(r.height + keep, most)});
  }
  if (const auto pair = model.nearest_to(t, clearance)) {
    const double distance = pair->distance;
    const Vec3 u = distance > touching * keep ? Vec3((pair->on_a - pair->on_b) / distance) : n;
    constraints.push_back({vertices, barycentric(pair->on_a, t), u, keep - distance});
  }
}

void KeepClear::add_point(const Triangle& vertices, const std::array<double, 3>& share,
                          const Vec3& p, std::vector<BlockConstraint>& constraints) const {
  const SurfaceTree::Nearest near = model.nearest(p, keep + reach);
  if (near.distance > touching * keep && std::isfinite(near.distance)) {
    const Vec3 u = (p - near.point) / near.distance;
    constraints.push_back({vertices, share, u, std::min(keep - near.distance, most)});
  }
}

void add_band(const SeamBand& band, const Vec3& p, Index v, double unit,
              std::vector<BlockConstraint>& constraints) {
  const double h = band.height(p);
  for (const double sign : {1.0, -1.0}) {
    const double room = std::max(0.0, band.half_width + sign * h) / unit;
    constraints.push_back({{v, v, v}, {1, 0, 0}, sign * band.normal, -room});
  }
}

std::array<double, 3> barycentric(const Vec3& p, const Corners& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double squared = n.squaredNorm();
  const double a = (t[2] - t[1]).cross(p - t[1]).dot(n) / squared;
  const double b = (t[0] - t[2]).cross(p - t[2]).dot(n) / squared;
  return {a, b, 1 - a - b};
}

} // namespace cagewright
