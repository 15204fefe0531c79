#include "improve/nearest_in_half_spaces.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace cagewright {

namespace {

using Vec2 = Eigen::Vector2d;

// A constraint is forgiven this much, relative to the offsets in play: two parallel planes that
// coincide must not make the program infeasible.
constexpr double forgiven = 1e-10;

struct HalfPlane {
  Vec2 normal; // length one
  double offset = 0;
};

// Least |t| with slope * t <= offset for all.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  void cut(double slope, double offset) {
    if (slope > 0) {
      high = std::min(high, offset / slope);
    } else {
      low = std::max(low, offset / slope);
    }
  }
};

std::optional<Vec2> nearest_in_half_planes(std::span<const HalfPlane> planes, double slack) {
  Vec2 at = Vec2::Zero();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const HalfPlane& p = planes[i];
    if (p.normal.dot(at) <= p.offset + slack) {
      continue;
    }
    const Vec2 foot = p.offset * p.normal;
    const Vec2 along(-p.normal.y(), p.normal.x());
    Interval interval;
    for (const HalfPlane& q : planes.first(i)) {
      const double slope = q.normal.dot(along);
      const double offset = q.offset - q.normal.dot(foot);
      if (std::abs(slope) > 1e-9) {
        interval.cut(slope, offset);
      } else if (offset < -slack) {
        return std::nullopt;
      }
    }
    if (interval.low > interval.high + slack) {
      return std::nullopt;
    }
    const double t = interval.low > 0 ? interval.low : std::min(interval.high, 0.0);
    at = foot + t * along;
  }
  return at;
}

std::optional<Vec3> nearest(std::span<const HalfSpace> spaces, double slack) {
  Vec3 at = Vec3::Zero();
  std::vector<HalfPlane> planes;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const HalfSpace& s = spaces[i];
    if (s.above(at) <= slack) {
      continue;
    }
    const Vec3 foot = s.offset * s.normal;
    const Vec3 u = s.normal.unitOrthogonal();
    const Vec3 v = s.normal.cross(u);
    planes.clear();
    for (const HalfSpace& r : spaces.first(i)) {
      const Vec2 normal(r.normal.dot(u), r.normal.dot(v));
      const double offset = -r.above(foot);
      const double length = normal.norm();
      if (length > 1e-9) {
        planes.push_back({normal / length, offset / length});
      } else if (offset < -slack) {
        return std::nullopt;
      }
    }
    const std::optional<Vec2> inside = nearest_in_half_planes(planes, slack);
    if (!inside) {
      return std::nullopt;
    }
    at = foot + inside->x() * u + inside->y() * v;
  }
  return at;
}

} // namespace

std::optional<Vec3> minimize_in_half_spaces(const Mat3& hessian, const Vec3& gradient,
                                            std::span<const HalfSpace> half_spaces) {
  // With H = L L' and x = x0 + L'^-1 y the objective is |y|^2 / 2: look for the least y.
  const Eigen::LLT<Mat3> factor(hessian);
  const Vec3 best = factor.solve(-gradient);
  std::vector<HalfSpace> scaled;
  scaled.reserve(half_spaces.size());
  double largest = 0;
  for (const HalfSpace& s : half_spaces) {
    const Vec3 normal = factor.matrixL().solve(s.normal);
    const double length = normal.norm();
    scaled.push_back({normal / length, -s.above(best) / length});
    largest = std::max(largest, std::abs(scaled.back().offset));
  }
  const std::optional<Vec3> y = nearest(scaled, forgiven * largest);
  if (!y) {
    return std::nullopt;
  }
  return best + factor.matrixU().solve(*y);
}

} // namespace cagewright
