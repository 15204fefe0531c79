#include "exact/predicates.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <initializer_list>

namespace cagewright {
namespace {

// Expansions after Shewchuk (1997): a number is the unevaluated sum of doubles that do not overlap,
// in order of growing magnitude, without zeros. All operations below are exact.

struct TwoSum {
  double high;
  double low;
};

TwoSum two_sum(double a, double b) {
  const double x = a + b;
  const double b_virtual = x - a;
  const double a_virtual = x - b_virtual;
  return {x, (a - a_virtual) + (b - b_virtual)};
}

TwoSum split(double a) {
  const double c = 134217729.0 * a; // 2^27 + 1
  const double high = c - (c - a);
  return {high, a - high};
}

TwoSum two_product(double a, double b) {
  const double x = a * b;
  const TwoSum p = split(a);
  const TwoSum q = split(b);
  const double error = ((x - p.high * q.high) - p.low * q.high) - p.high * q.low;
  return {x, p.low * q.low - error};
}

template <int N> struct Expansion {
  std::array<double, N> term;
  int size = 0;

  void push(double x) {
    if (x != 0) {
      term[size++] = x;
    }
  }
  [[nodiscard]] int sign() const { return size == 0 ? 0 : (term[size - 1] > 0 ? 1 : -1); }
};

Expansion<2> difference(double a, double b) {
  const TwoSum d = two_sum(a, -b);
  Expansion<2> result;
  result.push(d.low);
  result.push(d.high);
  return result;
}

/// e + f, or e - f: Shewchuk's FAST-EXPANSION-SUM.
template <int N, int M>
Expansion<N + M> sum(const Expansion<N>& e, const Expansion<M>& f, double sign_of_f = 1) {
  Expansion<N + M> result;
  int i = 0;
  int j = 0;
  const auto next = [&] {
    if (j == f.size || (i < e.size && std::abs(e.term[i]) < std::abs(f.term[j]))) {
      return e.term[i++];
    }
    return sign_of_f * f.term[j++];
  };
  const int total = e.size + f.size;
  if (total == 0) {
    return result;
  }
  double q = next();
  for (int k = 1; k < total; ++k) {
    const TwoSum s = two_sum(q, next());
    result.push(s.low);
    q = s.high;
  }
  result.push(q);
  return result;
}

/// e * b: Shewchuk's SCALE-EXPANSION.
template <int N> Expansion<2 * N> scaled(const Expansion<N>& e, double b) {
  Expansion<2 * N> result;
  if (e.size == 0) {
    return result;
  }
  const TwoSum first = two_product(e.term[0], b);
  result.push(first.low);
  double q = first.high;
  for (int i = 1; i < e.size; ++i) {
    const TwoSum product = two_product(e.term[i], b);
    const TwoSum low = two_sum(q, product.low);
    result.push(low.low);
    const TwoSum high = two_sum(product.high, low.high);
    result.push(high.low);
    q = high.high;
  }
  result.push(q);
  return result;
}

template <int N> Expansion<4 * N> product(const Expansion<N>& e, const Expansion<2>& f) {
  Expansion<4 * N> result;
  if (f.size == 1) {
    const Expansion<2 * N> only = scaled(e, f.term[0]);
    std::copy_n(only.term.begin(), only.size, result.term.begin());
    result.size = only.size;
  } else if (f.size == 2) {
    result = sum(scaled(e, f.term[0]), scaled(e, f.term[1]));
  }
  return result;
}

/// Expansions are exact as long as no product of three coordinates leaves the range of doubles.
bool in_range(std::initializer_list<double> coordinates) {
  return std::all_of(coordinates.begin(), coordinates.end(), [](double x) {
    return x == 0 || (std::abs(x) > 1e-75 && std::abs(x) < 1e75);
  });
}

// Outside that range: integers of any length, in units below the smallest double.
using Integer = boost::multiprecision::cpp_int;

Integer to_integer(double x) {
  int exponent = 0;
  const auto mantissa = static_cast<long long>(std::ldexp(std::frexp(x, &exponent), 53));
  Integer integer = mantissa;
  integer <<= exponent - 53 + 1127; // the smallest double has the exponent -1073
  return integer;
}

Integer determinant(const std::array<std::array<Integer, 3>, 3>& m) {
  const Integer x = m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const Integer y = m[1][2] * m[2][0] - m[1][0] * m[2][2];
  const Integer z = m[1][0] * m[2][1] - m[1][1] * m[2][0];
  return m[0][0] * x + m[0][1] * y + m[0][2] * z;
}

int orient3d_integer(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<std::array<Integer, 3>, 3> m;
  const std::array<const Vec3*, 3> rows = {&b, &c, &d};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      m[i][k] = to_integer((*rows[i])[k]) - to_integer(a[k]);
    }
  }
  return determinant(m).sign();
}

// ---- The plane, and segments in it

/// Closed segments that are known to lie in one plane, which `axis` does not lie in.
bool segments_intersect_2d(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, int axis) {
  const int r_side = orient2d(p, q, r, axis);
  const int s_side = orient2d(p, q, s, axis);
  const int p_side = orient2d(r, s, p, axis);
  const int q_side = orient2d(r, s, q, axis);
  if (r_side == 0 && s_side == 0 && p_side == 0 && q_side == 0) {
    // All on one line: the segments meet when their boxes do.
    return (p.cwiseMin(q).array() <= r.cwiseMax(s).array()).all() &&
           (r.cwiseMin(s).array() <= p.cwiseMax(q).array()).all();
  }
  return r_side * s_side <= 0 && p_side * q_side <= 0;
}

/// The same for a segment and a triangle that has area.
bool segment_intersects_triangle_2d(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                    const Vec3& c, int axis, int turn) {
  const auto inside = [&](const Vec3& x) {
    return orient2d(a, b, x, axis) * turn >= 0 && orient2d(b, c, x, axis) * turn >= 0 &&
           orient2d(c, a, x, axis) * turn >= 0;
  };
  return inside(p) || inside(q) || segments_intersect_2d(p, q, a, b, axis) ||
         segments_intersect_2d(p, q, b, c, axis) || segments_intersect_2d(p, q, c, a, axis);
}

/// An axis along which the triangle projects to one with area, and the turn it has there (0: none).
struct Projection {
  int axis;
  int turn;
};

Projection project(const Vec3& a, const Vec3& b, const Vec3& c) {
  // The axis nearest to the normal is the safest first guess; the answer does not depend on it.
  const Vec3 normal = (b - a).cross(c - a).cwiseAbs();
  const int first = normal.x() >= normal.y() ? (normal.x() >= normal.z() ? 0 : 2)
                                             : (normal.y() >= normal.z() ? 1 : 2);
  for (int k = 0; k < 3; ++k) {
    const int axis = (first + k) % 3;
    if (const int turn = orient2d(a, b, c, axis); turn != 0) {
      return {axis, turn};
    }
  }
  return {0, 0};
}

/// Given the sides of p and q of the plane a b c, which has area.
bool segment_with_sides_intersects(const Vec3& p, const Vec3& q, int p_side, int q_side,
                                   const Vec3& a, const Vec3& b, const Vec3& c) {
  if (p_side * q_side > 0) {
    return false;
  }
  if (p_side == 0 && q_side == 0) {
    const Projection plane = project(a, b, c);
    return segment_intersects_triangle_2d(p, q, a, b, c, plane.axis, plane.turn);
  }
  // The line meets the plane in one point, of the segment: on which side of each edge?
  const int ab = orient3d(p, q, a, b);
  const int bc = orient3d(p, q, b, c);
  if (ab * bc < 0) {
    return false;
  }
  const int ca = orient3d(p, q, c, a);
  return ab * ca >= 0 && bc * ca >= 0;
}

} // namespace

int exact_detail::orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // The usual reason to come here: triangles of one mesh that share a corner.
  if (d == a || d == b || d == c || a == b || b == c || c == a) {
    return 0;
  }
  if (!in_range(
          {a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(), c.y(), c.z(), d.x(), d.y(), d.z()})) {
    return orient3d_integer(a, b, c, d);
  }
  std::array<Expansion<2>, 3> u;
  std::array<Expansion<2>, 3> v;
  std::array<Expansion<2>, 3> w;
  for (int k = 0; k < 3; ++k) {
    u[k] = difference(b[k], a[k]);
    v[k] = difference(c[k], a[k]);
    w[k] = difference(d[k], a[k]);
  }
  const auto minor = [&](int i, int j) {
    return sum(product(u[i], v[j]), product(u[j], v[i]), -1);
  };
  const auto x = product(minor(1, 2), w[0]);
  const auto y = product(minor(2, 0), w[1]);
  const auto z = product(minor(0, 1), w[2]);
  return sum(sum(x, y), z).sign();
}

int exact_detail::orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  if (!in_range({ax, ay, bx, by, cx, cy})) {
    const Integer x = to_integer(ax);
    const Integer y = to_integer(ay);
    const Integer det =
        (to_integer(bx) - x) * (to_integer(cy) - y) - (to_integer(by) - y) * (to_integer(cx) - x);
    return det.sign();
  }
  const auto left = product(difference(bx, ax), difference(cy, ay));
  const auto right = product(difference(by, ay), difference(cx, ax));
  return sum(left, right, -1).sign();
}

bool segments_intersect(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  if (orient3d(p, q, r, s) != 0) {
    return false;
  }
  for (const auto& [a, b, c] : {std::array{&p, &q, &r}, std::array{&p, &q, &s},
                                std::array{&r, &s, &p}, std::array{&r, &s, &q}}) {
    if (const Projection plane = project(*a, *b, *c); plane.turn != 0) {
      return segments_intersect_2d(p, q, r, s, plane.axis);
    }
  }
  return (p.cwiseMin(q).array() <= r.cwiseMax(s).array()).all() &&
         (r.cwiseMin(s).array() <= p.cwiseMax(q).array()).all();
}

bool segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                 const Vec3& c) {
  if (is_degenerate(a, b, c)) {
    return segments_intersect(p, q, a, b) || segments_intersect(p, q, b, c) ||
           segments_intersect(p, q, c, a);
  }
  return segment_with_sides_intersects(p, q, orient3d(a, b, c, p), orient3d(a, b, c, q), a, b, c);
}

bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  const auto some_edge_meets = [](const Vec3(&edges)[3], const Vec3(&face)[3]) {
    for (int i = 0; i < 3; ++i) {
      if (segment_intersects_triangle(edges[i], edges[(i + 1) % 3], face[0], face[1], face[2])) {
        return true;
      }
    }
    return false;
  };
  if (is_degenerate(a[0], a[1], a[2])) {
    return some_edge_meets(a, b);
  }
  if (is_degenerate(b[0], b[1], b[2])) {
    return some_edge_meets(b, a);
  }
  std::array<int, 3> b_side;
  std::array<int, 3> a_side;
  for (int i = 0; i < 3; ++i) {
    b_side[i] = orient3d(a[0], a[1], a[2], b[i]);
  }
  if (std::abs(b_side[0] + b_side[1] + b_side[2]) == 3) {
    return false;
  }
  for (int i = 0; i < 3; ++i) {
    a_side[i] = orient3d(b[0], b[1], b[2], a[i]);
  }
  if (std::abs(a_side[0] + a_side[1] + a_side[2]) == 3) {
    return false;
  }
  // Two triangles meet when an edge of one meets the other.
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (segment_with_sides_intersects(a[i], a[j], a_side[i], a_side[j], b[0], b[1], b[2]) ||
        segment_with_sides_intersects(b[i], b[j], b_side[i], b_side[j], a[0], a[1], a[2])) {
      return true;
    }
  }
  return false;
}

bool triangles_cross_properly(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  const auto some_edge_passes = [](const Vec3(&edges)[3], const Vec3(&face)[3]) {
    std::array<int, 3> side;
    for (int i = 0; i < 3; ++i) {
      side[i] = orient3d(face[0], face[1], face[2], edges[i]);
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (side[i] * side[j] < 0) {
        const int first = orient3d(edges[i], edges[j], face[0], face[1]);
        if (first != 0 && orient3d(edges[i], edges[j], face[1], face[2]) == first &&
            orient3d(edges[i], edges[j], face[2], face[0]) == first) {
          return true;
        }
      }
    }
    return false;
  };
  return some_edge_passes(a, b) || some_edge_passes(b, a);
}

bool faces_cross(std::span<const Vec3> positions, const Triangle& a, const Triangle& b) {
  const auto is_shared = [](Index v, const Triangle& t) {
    return v == t[0] || v == t[1] || v == t[2];
  };
  const auto point = [&](const Triangle& t, int i) -> const Vec3& { return positions[t[i % 3]]; };
  int shared = 0;
  int odd_a = 0; // the corner of a that b lacks (two shared), or the one they share (one shared)
  int odd_b = 0;
  std::array<bool, 3> a_in_b;
  std::array<bool, 3> b_in_a;
  for (int i = 0; i < 3; ++i) {
    a_in_b[i] = is_shared(a[i], b);
    b_in_a[i] = is_shared(b[i], a);
    shared += a_in_b[i] ? 1 : 0;
  }
  if (shared == 0) {
    return triangles_intersect({point(a, 0), point(a, 1), point(a, 2)},
                               {point(b, 0), point(b, 1), point(b, 2)});
  }
  if (shared == 3) {
    return true;
  }
  for (int i = 0; i < 3; ++i) {
    odd_a = a_in_b[i] == (shared == 1) ? i : odd_a;
    odd_b = b_in_a[i] == (shared == 1) ? i : odd_b;
  }
  if (shared == 1) {
    // The common part is convex and holds the shared corner. If it holds more, then walking away
    // from the corner it ends on the edge opposite to it, of one triangle or of the other.
    return segment_intersects_triangle(point(a, odd_a + 1), point(a, odd_a + 2), point(b, 0),
                                       point(b, 1), point(b, 2)) ||
           segment_intersects_triangle(point(b, odd_b + 1), point(b, odd_b + 2), point(a, 0),
                                       point(a, 1), point(a, 2));
  }
  const Vec3& p = point(a, odd_a);
  const Vec3& r = point(b, odd_b);
  const Vec3& v = point(a, odd_a + 1);
  const Vec3& w = point(a, odd_a + 2);
  if (orient3d(v, w, p, r) != 0) {
    return false;
  }
  // Coplanar: folded over when both lie on the same side of the shared edge.
  const Projection plane = project(v, w, p);
  return plane.turn == 0 || orient2d(v, w, r, plane.axis) != -plane.turn;
}

int volume_sign(TriangleView mesh) {
  if (mesh.triangles.empty()) {
    return 0;
  }
  // In doubles first: the sum of the determinants, and of their magnitudes to bound its error.
  const Vec3 origin = mesh.positions[mesh.triangles[0][0]];
  double sum_of_all = 0;
  double magnitude = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]] - origin;
    const Vec3 b = mesh.positions[t[1]] - origin;
    const Vec3 c = mesh.positions[t[2]] - origin;
    sum_of_all += a.dot(b.cross(c));
    magnitude += a.lpNorm<1>() * b.lpNorm<1>() * c.lpNorm<1>();
  }
  const double bound = 1.2e-16 * (static_cast<double>(mesh.triangles.size()) + 16) * magnitude;
  if (std::abs(sum_of_all) > bound + 1e-150) {
    return sum_of_all > 0 ? 1 : -1;
  }
  // Then exactly. The choice of the origin does not matter to a closed mesh.
  Integer volume = 0;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::array<Integer, 3>, 3> m;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        m[i][k] = to_integer(mesh.positions[t[i]][k]);
      }
    }
    volume += determinant(m);
  }
  return volume.sign();
}

} // namespace cagewright
