/// \file
/// The yardstick: mean value coordinates as published, one point and one triangle at a time.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace cagewright::bench {

/// The pseudocode of Ju, Schaefer and Warren 2005, Figure 4, for weights instead of values, in
/// double: what a careful programmer writes from the paper. `weights` takes C numbers.
inline void published_weights(TriangleView cage, const Vec3& x, std::span<double> weights,
                              std::vector<double>& distance, std::vector<Vec3>& direction) {
  constexpr double epsilon = 1e-9;
  const std::size_t count = cage.positions.size();
  distance.resize(count);
  direction.resize(count);
  std::fill(weights.begin(), weights.end(), 0.0);
  for (std::size_t j = 0; j < count; ++j) {
    const Vec3 difference = cage.positions[j] - x;
    distance[j] = difference.norm();
    if (distance[j] < epsilon) {
      weights[j] = 1;
      return;
    }
    direction[j] = difference / distance[j];
  }
  for (const Triangle& t : cage.triangles) {
    const std::array<const Vec3*, 3> u = {&direction[t[0]], &direction[t[1]], &direction[t[2]]};
    std::array<double, 3> theta{};
    double h = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      theta[i] = 2 * std::asin(std::min(1.0, (*u[(i + 1) % 3] - *u[(i + 2) % 3]).norm() / 2));
      h += theta[i] / 2;
    }
    if (std::numbers::pi - h < epsilon) { // x lies on the triangle
      std::fill(weights.begin(), weights.end(), 0.0);
      for (std::size_t i = 0; i < 3; ++i) {
        weights[t[i]] = std::sin(theta[i]) * distance[t[(i + 1) % 3]] * distance[t[(i + 2) % 3]];
      }
      break;
    }
    const double sign = u[0]->dot(u[1]->cross(*u[2])) < 0 ? -1 : 1;
    std::array<double, 3> c{};
    std::array<double, 3> s{};
    bool in_plane = false;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = 2 * std::sin(h) * std::sin(h - theta[i]) /
                 (std::sin(theta[(i + 1) % 3]) * std::sin(theta[(i + 2) % 3])) -
             1;
      s[i] = sign * std::sqrt(std::max(0.0, 1 - c[i] * c[i]));
      in_plane = in_plane || std::abs(s[i]) <= epsilon;
    }
    if (in_plane) {
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      const std::size_t last = (i + 2) % 3;
      weights[t[i]] += (theta[i] - c[next] * theta[last] - c[last] * theta[next]) /
                       (distance[t[i]] * std::sin(theta[next]) * s[last]);
    }
  }
  double sum = 0;
  for (const double w : weights) {
    sum += w;
  }
  for (double& w : weights) {
    w /= sum;
  }
}

} // namespace cagewright::bench
