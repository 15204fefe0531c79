#include "validate/containment.h"

#include "core/random.h"
#include "exact/predicates.h"
#include "mesh/solid_angle.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

/// A point beyond the box, seen from p in a direction that depends on the attempt alone.
Vec3 far_point(const Vec3& p, const Box3& box, int attempt) {
  Random random(static_cast<std::uint64_t>(attempt) + 1);
  Vec3 direction;
  for (double& x : direction) {
    x = random.uniform(0.25, 1);
    x = random.below(2) == 0 ? x : -x;
  }
  direction[attempt % 3] *= 4;
  const double reach = 2 * (box.diagonal().norm() + (p - box.center()).norm());
  return p + reach * direction.normalized();
}

/// 1 or -1 when the segment passes through the triangle against or along its normal, seen from q;
/// 0 when they have no point in common; nothing when it meets an edge or a corner, or lies in its
/// plane. Neither end lies on the triangle.
std::optional<int> crossing(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                            const Vec3& c) {
  const int from = orient3d(a, b, c, p);
  const int to = orient3d(a, b, c, q);
  if (from == 0 && to == 0) {
    return segment_intersects_triangle(p, q, a, b, c) ? std::nullopt : std::optional(0);
  }
  if (from * to >= 0) {
    return 0; // an end in the plane lies beside the triangle
  }
  const int ab = orient3d(p, q, a, b);
  const int bc = orient3d(p, q, b, c);
  const int ca = orient3d(p, q, c, a);
  if (std::max({ab, bc, ca}) - std::min({ab, bc, ca}) == 2) {
    return 0;
  }
  if (ab == 0 || bc == 0 || ca == 0) {
    return std::nullopt;
  }
  return to;
}

} // namespace

Closure closure_of(std::span<const Triangle> triangles) {
  struct Use {
    Index low;
    Index high;
    int way;
  };
  std::vector<Use> uses;
  uses.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i];
      const Index b = t[(i + 1) % 3];
      if (a != b) {
        uses.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
      }
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  Closure closure = Closure::oriented;
  for (std::size_t i = 0; i < uses.size();) {
    int balance = 0;
    std::size_t k = i;
    for (; k < uses.size() && uses[k].low == uses[i].low && uses[k].high == uses[i].high; ++k) {
      balance += uses[k].way;
    }
    if ((k - i) % 2 != 0) {
      return Closure::open;
    }
    closure = balance != 0 ? Closure::even : closure;
    i = k;
  }
  return closure;
}

Containment::Containment(const CageParts& cage, Closure closure, std::vector<int> weights)
    : cage_(cage), closure_(closure), weights_(std::move(weights)),
      box_(bounding_box(TriangleView{cage.welded.positions, cage.triangles})) {}

Location Containment::locate(const Vec3& p, Index* face) const {
  if (!p.allFinite() || !box_.contains(p)) {
    return Location::outside;
  }
  const bool on_no_face = cage_.bvh.visit_box(Box3(p), [&](Index i) {
    const CagePart& part = cage_.parts[i];
    if (weights_[i] == 0 ||
        !segment_intersects_triangle(p, p, cage_.point(part, 0), cage_.point(part, 1),
                                     cage_.point(part, 2))) {
      return true;
    }
    if (face != nullptr) {
      *face = part.face;
    }
    return false;
  });
  if (!on_no_face) {
    return Location::on_surface;
  }
  const bool inside = is_inside(p, 0) && (!cage_.has_two_cuttings || is_inside(p, 1));
  return inside ? Location::inside : Location::outside;
}

bool Containment::is_inside(const Vec3& p, unsigned cutting) const {
  if (closure_ == Closure::open) {
    return solid_angle(p, cutting) >= 2 * std::numbers::pi;
  }
  constexpr int attempts = 200;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    if (const auto found = crossings(p, far_point(p, box_, attempt), cutting)) {
      return closure_ == Closure::oriented ? found->sum >= 1 : found->count % 2 != 0;
    }
  }
  return false; // every direction grazes an edge: not to be certified
}

std::optional<Containment::Crossings> Containment::crossings(const Vec3& p, const Vec3& q,
                                                             unsigned cutting) const {
  Crossings result;
  const bool clear = cage_.bvh.visit_segment(p, q, [&](Index i) {
    const CagePart& part = cage_.parts[i];
    if ((part.cuttings >> cutting & 1U) == 0 || part.is_degenerate || weights_[i] == 0) {
      return true;
    }
    const auto sign =
        crossing(p, q, cage_.point(part, 0), cage_.point(part, 1), cage_.point(part, 2));
    if (!sign) {
      return false;
    }
    result.sum += *sign * weights_[i];
    result.count += *sign != 0 ? 1 : 0;
    return true;
  });
  return clear ? std::optional(result) : std::nullopt;
}

double Containment::solid_angle(const Vec3& p, unsigned cutting) const {
  double sum = 0;
  for (std::size_t i = 0; i < cage_.parts.size(); ++i) {
    const CagePart& part = cage_.parts[i];
    if ((part.cuttings >> cutting & 1U) == 0) {
      continue;
    }
    sum += weights_[i] * cagewright::solid_angle(p, cage_.point(part, 0), cage_.point(part, 1),
                                                 cage_.point(part, 2));
  }
  return sum;
}

} // namespace cagewright
