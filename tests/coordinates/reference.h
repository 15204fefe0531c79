/// \file
/// Mean value coordinates as they are defined, in 113-bit arithmetic: slow, and nothing like the
/// code under test.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cagewright::test {

using Quad = boost::multiprecision::cpp_bin_float_quad;
using QuadVec3 = std::array<Quad, 3>;

inline QuadVec3 minus(const Vec3& a, const Vec3& b) {
  return {Quad(a.x()) - b.x(), Quad(a.y()) - b.y(), Quad(a.z()) - b.z()};
}
inline Quad dot(const QuadVec3& a, const QuadVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline QuadVec3 cross(const QuadVec3& a, const QuadVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The barycentric coordinates of a point in the plane of a triangle (p: its corners as seen from
/// the point).
inline QuadVec3 barycentric(const std::array<QuadVec3, 3>& p) {
  const auto area = [&](std::size_t i) { return cross(p[(i + 1) % 3], p[(i + 2) % 3]); };
  QuadVec3 normal = {0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      normal[k] += area(i)[k];
    }
  }
  const Quad square = dot(normal, normal);
  return {Quad(dot(area(0), normal) / square), Quad(dot(area(1), normal) / square),
          Quad(dot(area(2), normal) / square)};
}

/// The normalized weights of one point by the definition (Ju, Schaefer and Warren 2005, section
/// 3.1): the mean vector of each spherical triangle, written in its three corners. A face in whose
/// plane the point lies gives its barycentric coordinates if it holds the point, and otherwise
/// contributes nothing.
inline std::vector<double> reference_weights(TriangleView cage, const Vec3& point) {
  using std::max;
  std::vector<Quad> weights(cage.positions.size());
  for (const Triangle& t : cage.triangles) {
    const std::array<QuadVec3, 3> p = {minus(cage.positions[t[0]], point),
                                       minus(cage.positions[t[1]], point),
                                       minus(cage.positions[t[2]], point)};
    const Quad det = dot(p[0], cross(p[1], p[2]));
    const Quad size = max(dot(p[0], p[0]), max(dot(p[1], p[1]), dot(p[2], p[2])));
    if (abs(det) < Quad(1e-28) * size * sqrt(size)) {
      const QuadVec3 lambda = barycentric(p);
      if (std::min({lambda[0], lambda[1], lambda[2]}) > -1e-20) {
        std::vector<double> on_face(cage.positions.size(), 0.0);
        for (std::size_t i = 0; i < 3; ++i) {
          on_face[t[i]] = static_cast<double>(lambda[i]);
        }
        return on_face;
      }
      continue;
    }
    QuadVec3 mean = {0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      const QuadVec3 normal = cross(p[i], p[(i + 1) % 3]);
      const Quad sine = sqrt(dot(normal, normal));
      const Quad angle = atan2(sine, dot(p[i], p[(i + 1) % 3]));
      for (std::size_t k = 0; k < 3; ++k) {
        mean[k] += sine > 0 ? Quad(angle * normal[k] / (2 * sine)) : Quad(0);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      weights[t[i]] += dot(mean, cross(p[(i + 1) % 3], p[(i + 2) % 3])) / det;
    }
  }
  Quad sum = 0;
  for (const Quad& w : weights) {
    sum += w;
  }
  std::vector<double> normalized;
  for (const Quad& w : weights) {
    normalized.push_back(static_cast<double>(w / sum));
  }
  return normalized;
}

} // namespace cagewright::test
