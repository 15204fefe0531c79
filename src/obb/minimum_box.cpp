#include "obb/minimum_box.h"

#include "core/random.h"
#include "mesh/measures.h"
#include "obb/principal_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace cagewright {
namespace {

using Vec2 = Eigen::Vector2d;

// All lengths here are in units of the points' longest extent along a world axis.
constexpr double negligible = 1e-9;

// Volume of a box with these edges, with each edge lengthened a little: of flat sets of points,
// whose volume is always 0, it still ranks the boxes by area, and of straight ones by length.
double cost(const Vec3& edges) {
  return (edges.array() + negligible).prod();
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Convex hull, counter-clockwise and without collinear points (Andrew's monotone chain).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) {
    return points;
  }
  std::vector<Vec2> hull;
  const auto add = [&](const Vec2& p, std::size_t least) {
    while (hull.size() >= least &&
           cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vec2& p : points) {
    add(p, 2);
  }
  const std::size_t lower = hull.size() + 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) {
    add(*p, lower);
  }
  hull.pop_back();
  return hull;
}

// Direction of a side of the rectangle of least area round a convex polygon: rotating calipers.
Vec2 least_rectangle(const std::vector<Vec2>& hull) {
  const std::size_t n = hull.size();
  Vec2 best = Vec2::UnitX();
  double least = std::numeric_limits<double>::infinity();
  const auto next = [&](std::size_t i) { return i + 1 < n ? i + 1 : 0; };
  std::size_t right = 0;
  std::size_t top = 0;
  std::size_t left = 0;
  for (std::size_t i = 0; i < n && n > 1; ++i) {
    const Vec2 u = (hull[next(i)] - hull[i]).normalized();
    const Vec2 v(-u.y(), u.x());
    // Each caliper only ever moves on, at most once round: the loops end.
    const auto climb = [&](std::size_t& at, const Vec2& direction) {
      for (std::size_t k = 0; k < n && direction.dot(hull[next(at)] - hull[at]) > 0; ++k) {
        at = next(at);
      }
    };
    climb(right, u);
    if (i == 0) {
      top = right;
    }
    climb(top, v);
    if (i == 0) {
      left = top;
    }
    climb(left, -u);
    const double width = u.dot(hull[right] - hull[left]);
    const double height = v.dot(hull[top] - hull[i]);
    const double area = (width + negligible) * (height + negligible);
    if (area < least) {
      least = area;
      best = u;
    }
  }
  return best;
}

class Search {
public:
  Search(std::span<const Vec3> points, const Vec3& origin, double unit)
      : points_(points.size(), 3) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points_.row(static_cast<Eigen::Index>(i)) = (points[i] - origin) / unit;
    }
    take_extremes(Mat3::Identity());
  }

  // Improves the frame until no turn about one of its axes gains, and keeps it if it is the best.
  void descend_from(const Mat3& start) {
    Mat3 axes = start;
    double value = cost(take_extremes(axes));
    int idle = 0;
    for (int step = 0; idle < 3 && step < 60; ++step) {
      const Mat3 turned = turn_about(step % 3, axes);
      const double after = cost(take_extremes(turned));
      const bool gains = after < value * (1 - 1e-7);
      idle = gains ? 0 : idle + 1;
      if (gains) {
        axes = turned;
        value = after;
      }
    }
    if (value < value_) {
      value_ = value;
      axes_ = axes;
    }
  }

  [[nodiscard]] const Mat3& best() const { return axes_; }

private:
  // The frame with this axis and a rectangle of least area across it.
  Mat3 turn_about(int axis, const Mat3& axes) {
    Mat3 turned = axes;
    const Vec3 u = axes.col((axis + 1) % 3);
    const Vec3 v = axes.col((axis + 2) % 3);
    // Each round adds a point to the core, and few are needed; the bound is for safety only.
    for (int round = 0; round < 32; ++round) {
      std::vector<Vec2> seen(core_.size());
      for (std::size_t i = 0; i < core_.size(); ++i) {
        seen[i] = {u.dot(core_[i]), v.dot(core_[i])};
      }
      const Vec2 side = least_rectangle(convex_hull(std::move(seen)));
      turned.col((axis + 1) % 3) = (side.x() * u + side.y() * v).normalized();
      turned.col((axis + 2) % 3) = axes.col(axis).cross(turned.col((axis + 1) % 3)).normalized();
      const std::size_t before = core_.size();
      take_extremes(turned);
      if (core_.size() == before) {
        break;
      }
    }
    return turned;
  }

  // Edges of the box of all points in this frame; its extreme points join the core where the core
  // does not reach as far.
  Vec3 take_extremes(const Mat3& axes) {
    Vec3 edges;
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = axes.col(k);
      projected_.noalias() = points_ * axis;
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const Vec3& p : core_) {
        low = std::min(low, axis.dot(p));
        high = std::max(high, axis.dot(p));
      }
      const double least = projected_.minCoeff();
      const double greatest = projected_.maxCoeff();
      if (least < low - negligible) {
        add_to_core(least);
      }
      if (greatest > high + negligible) {
        add_to_core(greatest);
      }
      edges[k] = greatest - least;
    }
    return edges;
  }

  void add_to_core(double value) {
    Eigen::Index i = 0;
    while (projected_[i] != value) {
      ++i;
    }
    core_.emplace_back(points_.row(i));
  }

  Eigen::Matrix<double, Eigen::Dynamic, 3> points_;
  Eigen::VectorXd projected_; // scratch: points_ along an axis
  std::vector<Vec3> core_;
  Mat3 axes_ = Mat3::Identity();
  double value_ = std::numeric_limits<double>::infinity();
};

// Uniform over all rotations (Shoemake 1992).
Mat3 random_frame(Random& random) {
  const double r = random.uniform();
  const double a = random.uniform(0, 2 * std::numbers::pi);
  const double b = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Quaterniond q(std::sqrt(1 - r) * std::sin(a), std::sqrt(1 - r) * std::cos(a),
                             std::sqrt(r) * std::sin(b), std::sqrt(r) * std::cos(b));
  return q.normalized().toRotationMatrix();
}

} // namespace

OrientedBox minimum_box(std::span<const Vec3> points, const MinimumBoxOptions& options) {
  const Box3 extent = bounding_box(points);
  const double unit = extent.isEmpty() ? 0 : extent.sizes().maxCoeff();
  if (!(unit > 0)) {
    return box_in_frame(Mat3::Identity(), points);
  }
  const OrientedBox pca = pca_box(points);
  Search search(points, extent.center(), unit);
  search.descend_from(pca.axes);
  search.descend_from(Mat3::Identity());
  for (const Mat3& seed : options.seeds) {
    search.descend_from(seed);
  }
  Random random(1);
  for (int i = 0; i < options.extra_starts; ++i) {
    search.descend_from(random_frame(random));
  }
  const OrientedBox best = box_in_frame(search.best(), points);
  return sorted_by_length(best.volume() <= pca.volume() ? best : pca);
}

} // namespace cagewright
