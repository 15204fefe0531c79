#include "spatial/distance.h"

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

double cut(double numerator, double denominator) {
  return denominator > 0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

/// Where the segment p q passes through the triangle, if it does so properly (to rounding).
bool pierces(const Vec3& p, const Vec3& q, const Vec3 (&t)[3], Vec3& at) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double from = normal.dot(p - t[0]);
  const double to = normal.dot(q - t[0]);
  if (from * to > 0 || from == to) {
    return false;
  }
  at = p + (from / (from - to)) * (q - p);
  return (t[1] - t[0]).cross(at - t[0]).dot(normal) >= 0 &&
         (t[2] - t[1]).cross(at - t[1]).dot(normal) >= 0 &&
         (t[0] - t[2]).cross(at - t[2]).dot(normal) >= 0;
}

/// For a triangle that is nearly or wholly a segment, where the regions of corners, edges and face
/// cannot be told apart by products of projections: the best of all candidates.
Vec3 nearest_on_sliver(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 best = nearest_on_segment(p, a, b);
  const auto offer = [&](const Vec3& x) {
    if ((p - x).squaredNorm() < (p - best).squaredNorm()) {
      best = x;
    }
  };
  offer(nearest_on_segment(p, b, c));
  offer(nearest_on_segment(p, c, a));
  const Vec3 normal = (b - a).cross(c - a);
  const double at_b = (p - a).cross(c - a).dot(normal);
  const double at_c = (b - a).cross(p - a).dot(normal);
  const double whole = normal.squaredNorm();
  if (at_b > 0 && at_c > 0 && at_b + at_c < whole) {
    offer(a + (at_b / whole) * (b - a) + (at_c / whole) * (c - a));
  }
  return best;
}

} // namespace

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  return a + cut(ab.dot(p - a), ab.squaredNorm()) * ab;
}

Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  // Below an angle of a hundredth at a the error of the products exceeds some 1e-12.
  const double ab_ac = ab.dot(ac);
  const double both = ab.squaredNorm() * ac.squaredNorm();
  if (both - ab_ac * ab_ac <= 1e-4 * both) {
    return nearest_on_sliver(p, a, b, c);
  }
  if (d1 <= 0 && d2 <= 0) {
    return a;
  }
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) {
    return b;
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) {
    return c;
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    return a + cut(d1, d1 - d3) * ab;
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    return a + cut(d2, d2 - d6) * ac;
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return b + cut(d4 - d3, (d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double scale = 1 / (va + vb + vc);
  return a + (vb * scale) * ab + (vc * scale) * ac;
}

double point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (p - nearest_on_triangle(p, a, b, c)).norm();
}

ClosestPoints segment_segment_closest(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  // Ericson, section 5.1.9: the nearest points of the lines, clamped to the one segment, then to
  // the other, then once more to the first.
  const Vec3 d1 = q - p;
  const Vec3 d2 = s - r;
  const Vec3 w = p - r;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double b = d1.dot(d2);
  const double c = d1.dot(w);
  const double f = d2.dot(w);
  double on_first = cut(b * f - c * e, a * e - b * b);
  double on_second = e > 0 ? (b * on_first + f) / e : 0;
  if (on_second <= 0 || on_second >= 1) {
    on_second = std::clamp(on_second, 0.0, 1.0);
    on_first = cut(b * on_second - c, a);
  }
  const Vec3 x = p + on_first * d1;
  const Vec3 y = r + on_second * d2;
  return {(x - y).norm(), x, y};
}

ClosestPoints triangle_triangle_closest(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  ClosestPoints best{HUGE_VAL, a[0], b[0]};
  const auto offer = [&](const Vec3& x, const Vec3& y) {
    if (const double distance = (x - y).norm(); distance < best.distance) {
      best = {distance, x, y};
    }
  };
  for (int i = 0; i < 3; ++i) {
    offer(a[i], nearest_on_triangle(a[i], b[0], b[1], b[2]));
    offer(nearest_on_triangle(b[i], a[0], a[1], a[2]), b[i]);
    for (int j = 0; j < 3; ++j) {
      const ClosestPoints edges =
          segment_segment_closest(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      if (edges.distance < best.distance) {
        best = edges;
      }
    }
  }
  for (int i = 0; i < 3 && best.distance > 0; ++i) {
    if (Vec3 at; pierces(a[i], a[(i + 1) % 3], b, at) || pierces(b[i], b[(i + 1) % 3], a, at)) {
      best = {0, at, at};
    }
  }
  return best;
}

double triangle_triangle_distance(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  return triangle_triangle_closest(a, b).distance;
}

} // namespace cagewright
