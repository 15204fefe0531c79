#include "improve/closest.h"

#include <algorithm>
#include <limits>

namespace cagewright {

namespace {

Vec3 nearest_in_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  return length > 0 ? Vec3(a + std::clamp(ab.dot(p - a) / length, 0.0, 1.0) * ab) : a;
}

void keep_nearer(NearestPair& best, const NearestPair& other) {
  if (other.squared < best.squared) {
    best = other;
  }
}

// Where the segment passes through the triangle: both ends on different sides of its plane and the
// crossing inside. Crossings within rounding of the border are found by the edges instead.
bool pierces(const Vec3& p, const Vec3& q, const Corners& t, Vec3& where) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double hp = n.dot(p - t[0]);
  const double hq = n.dot(q - t[0]);
  if ((hp > 0) == (hq > 0)) {
    return false;
  }
  where = p + hp / (hp - hq) * (q - p);
  for (int i = 0; i < 3; ++i) {
    const Vec3& a = t[i];
    const Vec3& b = t[(i + 1) % 3];
    if ((b - a).cross(where - a).dot(n) < 0) {
      return false;
    }
  }
  return true;
}

} // namespace

Vec3 nearest_in_triangle(const Vec3& p, const Corners& t) {
  const Vec3& a = t[0];
  const Vec3& b = t[1];
  const Vec3& c = t[2];
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) {
    return a;
  }
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) {
    return b;
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    return nearest_in_segment(p, a, b);
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) {
    return c;
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    return nearest_in_segment(p, a, c);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return nearest_in_segment(p, b, c);
  }
  const double sum = va + vb + vc;
  return sum > 0 ? Vec3(a + vb / sum * ab + vc / sum * ac) : nearest_in_segment(p, a, b);
}

NearestPair nearest_of_segments(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Vec3 u = q - p;
  const Vec3 v = s - r;
  const Vec3 w = p - r;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uw = u.dot(w);
  const double vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  double i = det > 1e-14 * uu * vv ? std::clamp((uv * vw - vv * uw) / det, 0.0, 1.0) : 0;
  double j = vv > 0 ? (uv * i + vw) / vv : 0;
  if (j < 0 || j > 1) {
    j = std::clamp(j, 0.0, 1.0);
    i = uu > 0 ? std::clamp((uv * j - uw) / uu, 0.0, 1.0) : 0;
  }
  NearestPair pair{0, p + i * u, r + j * v};
  pair.squared = (pair.first - pair.second).squaredNorm();
  return pair;
}

NearestPair nearest_of_triangles(const Corners& a, const Corners& b) {
  NearestPair best{std::numeric_limits<double>::infinity(), a[0], b[0]};
  for (int i = 0; i < 3; ++i) {
    const Vec3 on_b = nearest_in_triangle(a[i], b);
    keep_nearer(best, {(a[i] - on_b).squaredNorm(), a[i], on_b});
    const Vec3 on_a = nearest_in_triangle(b[i], a);
    keep_nearer(best, {(b[i] - on_a).squaredNorm(), on_a, b[i]});
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      keep_nearer(best, nearest_of_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
  }
  Vec3 where;
  for (int i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b, where) || pierces(b[i], b[(i + 1) % 3], a, where)) {
      return {0, where, where};
    }
  }
  return best;
}

} // namespace cagewright
