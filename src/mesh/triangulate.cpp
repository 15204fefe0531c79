#include <cagewright/mesh/triangulate.h>

#include "mesh/concave.h"
#include "mesh/turn.h"

#include <utility>

namespace cagewright {
namespace {

/// Twice the area vector of the polygon (Newell's method): its direction is the best normal.
Vec3 area_vector(std::span<const Vec3> positions, std::span<const Index> face) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = positions[face[0]];
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    sum += (positions[face[i]] - origin).cross(positions[face[i + 1]] - origin);
  }
  return sum;
}

/// Twice the signed area of a b c seen along `normal`.
double signed_area(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return (b - a).cross(c - a).dot(normal);
}

/// Ears are cut one after the other: a corner whose triangle holds no other corner of what is left
/// of the polygon, and whose third side runs inside it at both ends. The latter matters where a
/// corner is visited twice, as by a bridge to a hole that is walked there and back: each visit sees
/// only the part of the plane between its own two sides.
///
/// Meisters, "Polygons Have Ears", 1975; that only reflex corners can be in the way: Toussaint
/// 1991.
class EarClipper {
public:
  EarClipper(std::span<const Vec3> positions, std::span<const Index> face)
      : positions_(positions), ring_(face.begin(), face.end()),
        view_(PlaneView::of(area_vector(positions, face))) {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      is_reflex_.push_back(reflex_at(i));
      reflex_count_ += is_reflex_[i] ? 1U : 0U;
    }
  }

  /// The second corner is tried first, so that a convex polygon becomes a fan round its first.
  void clip(std::vector<Triangle>& triangles) {
    std::size_t ear = 1;
    while (ring_.size() > 3) {
      ear = find_ear(ear);
      cut(ear, triangles);
      ear = ear < ring_.size() ? ear : 0;
    }
    triangles.push_back({ring_[0], ring_[1], ring_[2]});
  }

private:
  [[nodiscard]] std::size_t wrapped(std::size_t i) const { return i % ring_.size(); }
  [[nodiscard]] std::size_t before(std::size_t i) const { return wrapped(i + ring_.size() - 1); }
  [[nodiscard]] const Vec3& position(std::size_t i) const { return positions_[ring_[wrapped(i)]]; }

  void cut(std::size_t ear, std::vector<Triangle>& triangles) {
    triangles.push_back({ring_[before(ear)], ring_[ear], ring_[wrapped(ear + 1)]});
    set_reflex(ear, false);
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
    is_reflex_.erase(is_reflex_.begin() + static_cast<std::ptrdiff_t>(ear));
    set_reflex(before(ear), reflex_at(before(ear)));
    set_reflex(wrapped(ear), reflex_at(wrapped(ear)));
  }

  void set_reflex(std::size_t i, bool is_reflex) {
    reflex_count_ -= is_reflex_[i] ? 1U : 0U;
    reflex_count_ += is_reflex ? 1U : 0U;
    is_reflex_[i] = is_reflex;
  }

  /// The first ear from `from` on. Where there is none the polygon is degenerate, or crosses
  /// itself: then a corner that takes no area, or else any.
  [[nodiscard]] std::size_t find_ear(std::size_t from) const {
    for (const auto is_good : {&EarClipper::is_ear, &EarClipper::is_spike, &EarClipper::is_flat}) {
      for (std::size_t k = 0; k < ring_.size(); ++k) {
        if (const std::size_t i = wrapped(from + k); (this->*is_good)(i)) {
          return i;
        }
      }
    }
    return from;
  }

  [[nodiscard]] int turn_at(std::size_t i) const {
    return turn(position(before(i)), position(i), position(i + 1), view_);
  }

  /// Whether the inside at a corner is 180 degrees or more: also at the end of a crack, where the
  /// polygon turns right back.
  [[nodiscard]] bool reflex_at(std::size_t i) const { return turn_at(i) <= 0; }

  [[nodiscard]] bool is_spike(std::size_t i) const {
    const Vec3& a = position(before(i));
    const Vec3& b = position(i);
    const Vec3& c = position(i + 1);
    return a == b || b == c || a == c;
  }

  [[nodiscard]] bool is_flat(std::size_t i) const { return turn_at(i) == 0; }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    if (is_reflex_[i]) {
      return false;
    }
    const Vec3& a = position(before(i));
    const Vec3& b = position(i);
    const Vec3& c = position(i + 1);
    return sees_between(before(i), c, true) && sees_between(wrapped(i + 1), a, false) &&
           !holds_a_corner(a, b, c);
  }

  /// Whether the side of an ear that runs from corner k to p is between the two sides of k. With
  /// the ear before it (or behind it) only the other side can be in the way, and only if k is
  /// convex.
  [[nodiscard]] bool sees_between(std::size_t k, const Vec3& p, bool ear_follows) const {
    if (turn_at(k) < 0 || is_crack(k)) {
      return true;
    }
    return ear_follows ? turn(position(k), p, position(before(k)), view_) > 0
                       : turn(p, position(k), position(k + 1), view_) > 0;
  }

  /// Whether the polygon turns right back at corner k.
  [[nodiscard]] bool is_crack(std::size_t k) const {
    const Vec3 in = position(before(k)) - position(k);
    const Vec3 out = position(k + 1) - position(k);
    return turn_at(k) == 0 && in.dot(out) > 0;
  }

  [[nodiscard]] bool holds_a_corner(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 low = a.cwiseMin(b).cwiseMin(c);
    const Vec3 high = a.cwiseMax(b).cwiseMax(c);
    const int u = view_.axis == 2 ? 0 : view_.axis + 1;
    const int v = view_.axis == 0 ? 2 : view_.axis - 1;
    for (std::size_t k = 0; reflex_count_ > 0 && k < ring_.size(); ++k) {
      if (!is_reflex_[k]) {
        continue;
      }
      const Vec3& p = position(k);
      const bool is_far = p[u] < low[u] || p[u] > high[u] || p[v] < low[v] || p[v] > high[v];
      if (is_far || p == a || p == b || p == c) {
        continue;
      }
      if (turn(a, b, p, view_) >= 0 && turn(b, c, p, view_) >= 0 && turn(c, a, p, view_) >= 0) {
        return true;
      }
    }
    return false;
  }

  std::span<const Vec3> positions_;
  std::vector<Index> ring_; // what is left
  PlaneView view_;
  std::vector<bool> is_reflex_; // as ring_
  std::size_t reflex_count_ = 0;
};

void cut_quad(std::span<const Vec3> x, std::span<const Index> q, std::vector<Triangle>& triangles) {
  const Vec3 normal = area_vector(x, q);
  const auto convex_at = [&](std::size_t i) {
    return signed_area(x[q[(i + 3) % 4]], x[q[i]], x[q[(i + 1) % 4]], normal) >= 0;
  };
  if (convex_at(1) && convex_at(3)) {
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  } else {
    triangles.push_back({q[1], q[2], q[3]});
    triangles.push_back({q[1], q[3], q[0]});
  }
}

} // namespace

std::optional<std::size_t> concave_corner(std::span<const Vec3> positions,
                                          std::span<const Index> face) {
  const PlaneView view = PlaneView::of(area_vector(positions, face));
  const std::size_t n = face.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(positions[face[(i + n - 1) % n]], positions[face[i]], positions[face[(i + 1) % n]],
             view) < 0) {
      return i;
    }
  }
  return std::nullopt;
}

Triangulation triangulate(const PolygonMesh& mesh) {
  Triangulation result;
  result.triangles.reserve(mesh.corners().size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    if (face.size() == 3) {
      result.triangles.push_back({face[0], face[1], face[2]});
    } else if (face.size() == 4) {
      cut_quad(mesh.positions, face, result.triangles);
    } else {
      EarClipper(mesh.positions, face).clip(result.triangles);
    }
    result.face_of.resize(result.triangles.size(), static_cast<Index>(f));
  }
  return result;
}

TriangleMesh to_triangle_mesh(const PolygonMesh& mesh) {
  return {mesh.positions, triangulate(mesh).triangles};
}

} // namespace cagewright
