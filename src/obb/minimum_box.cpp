#include "obb/minimum_box.h"

#include "core/maths.h"
#include "core/random.h"
#include "core/rotation.h"
#include "obb/principal_axes.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
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

// Sorts the points and leaves of them the corners of their convex hull, counter-clockwise and
// without collinear ones, in `hull` (Andrew's monotone chain).
void convex_hull(std::vector<Vec2>& points, std::vector<Vec2>& hull) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  hull.clear();
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
  if (points.size() < 3) {
    return;
  }
  const std::size_t lower = hull.size() + 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) {
    add(*p, lower);
  }
  hull.pop_back();
}

struct Rectangle {
  Vec2 side = Vec2::UnitX(); // direction of the width
  double width = 0;
  double height = 0;
};

// The rectangle of least area round a convex polygon: rotating calipers.
Rectangle least_rectangle(const std::vector<Vec2>& hull) {
  const std::size_t n = hull.size();
  Rectangle best;
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
      best = {u, width, height};
    }
  }
  return best;
}

// Uniform over all rotations (Shoemake 1992).
Mat3 random_frame(Random& random) {
  const double r = random.uniform();
  const double a = random.uniform(0, 2 * std::numbers::pi);
  const double b = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Quaterniond q(std::sqrt(1 - r) * maths::sin(a), std::sqrt(1 - r) * maths::cos(a),
                             std::sqrt(r) * maths::sin(b), std::sqrt(r) * maths::cos(b));
  return q.normalized().toRotationMatrix();
}

// The points, of which a few that are extreme in some direction, the core, stand for all.
class Search {
public:
  Search(std::span<const Vec3> points, const Vec3& origin, double unit)
      : points_(points.size(), 3) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points_.row(static_cast<Eigen::Index>(i)) = (points[i] - origin) / unit;
    }
    // With the extremes along a cube's axes, diagonals of faces and diagonals of space the core has
    // the shape of the points from the first.
    for (const Vec3& direction :
         {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(1, 0, 1),
          Vec3(1, 0, -1), Vec3(0, 1, 1), Vec3(0, 1, -1), Vec3(1, 1, 1), Vec3(1, -1, 1),
          Vec3(1, 1, -1), Vec3(-1, 1, 1)}) {
      reach_along(direction);
    }
  }

  // Improves the frame until no turn about one of its axes gains, and keeps it if it is the best.
  void descend_from(const Mat3& start) {
    Mat3 axes = start;
    bool grown = true;
    for (int looks = 0; grown && looks < most_looks; ++looks) {
      // The core's box is never larger than that of all points: what does not promise a gain in it
      // is not worth a look at all of them.
      if (descend_in_core(axes) >= value_ * (1 - worthwhile)) {
        return;
      }
      const std::size_t before = core_.size();
      const double value = cost(reach(axes));
      if (value < value_) {
        value_ = value;
        axes_ = axes;
      }
      grown = core_.size() > before;
    }
  }

  // Of three kinds in turn: any frame, one with an axis along the line through two points of the
  // core (which for polyhedra is often an edge), and the best frame so far turned a little.
  Mat3 random_start(int kind, Random& random) const {
    const Mat3 any = random_frame(random);
    const Vec3& from = core_[random.below(core_.size())];
    const Vec3 d = core_[random.below(core_.size())] - from;
    if (kind % 3 == 1 && d.norm() > negligible) {
      const Vec3 axis = d.normalized();
      const Vec3 other = axis.unitOrthogonal();
      return (Mat3() << axis, other, axis.cross(other)).finished();
    }
    if (kind % 3 == 2) {
      const double most = random.uniform(0, 0.3);
      return rotation_about(any.col(0), random.uniform(0, most)) * axes_;
    }
    return any;
  }

  [[nodiscard]] const Mat3& best() const { return axes_; }

private:
  static constexpr double gain = 1e-5;       // least relative gain of a turn
  static constexpr double worthwhile = 1e-4; // least relative gain of a further look at all points
  // Points of a sphere promise a gain for as long as the core has fewer corners than they, and all
  // their boxes are alike. Other real models take 32 looks at most, most of them fewer than ten.
  static constexpr int most_looks = 40;

  // Improves the frame for the core, and returns the cost of its box.
  double descend_in_core(Mat3& axes) {
    Vec3 edges = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = extent_of_core(axes.col(k));
      edges[k] = high - low;
    }
    int idle = 0;
    for (int axis = 0; idle < 3; axis = (axis + 1) % 3) {
      const double before = cost(edges);
      Mat3 turned = axes;
      const Vec3 turned_edges = turn_about(axis, turned, edges);
      const bool gains = cost(turned_edges) < before * (1 - gain);
      idle = gains ? 1 : idle + 1; // the axis just turned about has nothing more to give
      if (gains) {
        axes = turned;
        edges = turned_edges;
      }
    }
    return cost(edges);
  }

  // Turns the frame about one axis to the rectangle of least area across it, and returns the edges.
  Vec3 turn_about(int axis, Mat3& axes, Vec3 edges) {
    const Vec3 u = axes.col((axis + 1) % 3);
    const Vec3 v = axes.col((axis + 2) % 3);
    seen_.resize(core_.size());
    for (std::size_t i = 0; i < core_.size(); ++i) {
      seen_[i] = {u.dot(core_[i]), v.dot(core_[i])};
    }
    convex_hull(seen_, hull_);
    const Rectangle r = least_rectangle(hull_);
    axes.col((axis + 1) % 3) = (r.side.x() * u + r.side.y() * v).normalized();
    axes.col((axis + 2) % 3) = axes.col(axis).cross(axes.col((axis + 1) % 3)).normalized();
    edges[(axis + 1) % 3] = r.width;
    edges[(axis + 2) % 3] = r.height;
    return edges;
  }

  [[nodiscard]] std::pair<double, double> extent_of_core(const Vec3& direction) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& p : core_) {
      const double at = direction.dot(p);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    return {low, high};
  }

  // Edges of the box of all points in this frame.
  Vec3 reach(const Mat3& axes) {
    return {reach_along(axes.col(0)), reach_along(axes.col(1)), reach_along(axes.col(2))};
  }

  // Extent of all points along a direction. The extreme points join the core if it does not reach
  // as far.
  double reach_along(const Vec3& direction) {
    projected_.noalias() = points_ * direction;
    const auto [low, high] = extent_of_core(direction);
    const double least = projected_.minCoeff();
    const double greatest = projected_.maxCoeff();
    if (least < low - negligible) {
      add_to_core(least);
    }
    if (greatest > high + negligible) {
      add_to_core(greatest);
    }
    return greatest - least;
  }

  void add_to_core(double value) {
    Eigen::Index i = 0;
    while (projected_[i] != value) {
      ++i;
    }
    core_.emplace_back(points_.row(i));
  }

  Eigen::Matrix<double, Eigen::Dynamic, 3> points_;
  std::vector<Vec3> core_;
  Mat3 axes_ = Mat3::Identity(); // the best so far
  double value_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd projected_; // scratch: points_ along a direction
  std::vector<Vec2> seen_;    // scratch: core_ along an axis, and its hull
  std::vector<Vec2> hull_;
};

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
    search.descend_from(search.random_start(i, random));
  }
  const OrientedBox best = box_in_frame(search.best(), points);
  return sorted_by_length(best.volume() <= pca.volume() ? best : pca);
}

} // namespace cagewright
