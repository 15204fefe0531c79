#include "improve/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cagewright {

namespace {

constexpr Index leaf_size = 4;
// Median splits halve the count at every level: 2^32 triangles need 32.
constexpr int deepest = 64;

double squared_distance(const Vec3& center, const Vec3& half, const Vec3& p) {
  return ((p - center).cwiseAbs() - half).cwiseMax(0).squaredNorm();
}

// Lower bounds of the distance between a triangle and boxes: the greatest over the axes of the
// triangle's box, its normal, and the outward normals of its sides.
class TriangleBound {
public:
  explicit TriangleBound(const Corners& t) : corners_(t) {
    const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const Vec3 high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    center_ = (low + high) / 2;
    half_ = (high - low) / 2;
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = n.norm();
    if (area > 0) {
      add(n / area, true);
      for (int i = 0; i < 3; ++i) {
        const Vec3 out = (t[(i + 1) % 3] - t[i]).cross(n);
        const double length = out.norm();
        if (length > 0) {
          add(out / length, false);
        }
      }
    }
  }

  [[nodiscard]] bool beyond(const Vec3& center, const Vec3& half, double distance) const {
    const Vec3 gap = ((center - center_).cwiseAbs() - half - half_).cwiseMax(0);
    if (gap.squaredNorm() > distance * distance) {
      return true;
    }
    for (int i = 0; i < count_; ++i) {
      const Axis& axis = axes_[i];
      const double reach = axis.magnitude.dot(half) + distance;
      const double at = axis.normal.dot(center);
      if (at - reach > axis.high || (axis.two_sided && at + reach < axis.low)) {
        return true;
      }
    }
    return false;
  }

  // The same for a triangle.
  [[nodiscard]] bool beyond(const Corners& t, double distance) const {
    for (int k = 0; k < 3; ++k) {
      const double low = std::min({t[0][k], t[1][k], t[2][k]});
      const double high = std::max({t[0][k], t[1][k], t[2][k]});
      if (low - distance > center_[k] + half_[k] || high + distance < center_[k] - half_[k]) {
        return true;
      }
    }
    for (int i = 0; i < count_; ++i) {
      const Axis& axis = axes_[i];
      const double a = axis.normal.dot(t[0]);
      const double b = axis.normal.dot(t[1]);
      const double c = axis.normal.dot(t[2]);
      if (std::min({a, b, c}) - distance > axis.high ||
          (axis.two_sided && std::max({a, b, c}) + distance < axis.low)) {
        return true;
      }
    }
    return false;
  }

private:
  struct Axis {
    Vec3 normal;
    Vec3 magnitude;
    double low = 0;
    double high = 0;
    bool two_sided = false;
  };

  void add(const Vec3& normal, bool two_sided) {
    const double a = normal.dot(corners_[0]);
    const double b = normal.dot(corners_[1]);
    const double c = normal.dot(corners_[2]);
    axes_[count_++] = {normal, normal.cwiseAbs(), std::min({a, b, c}), std::max({a, b, c}),
                       two_sided};
  }

  Corners corners_;
  Vec3 center_;
  Vec3 half_;
  std::array<Axis, 4> axes_;
  int count_ = 0;
};

// A convex polygon cut by half spaces in place. Each cut adds one corner at most.
class Clipped {
public:
  explicit Clipped(const Corners& t) : size_(3) { std::copy(t.begin(), t.end(), points_.begin()); }

  void cut(const HalfSpace& keep) {
    std::array<Vec3, 10> kept;
    int count = 0;
    for (int i = 0; i < size_; ++i) {
      const Vec3& p = points_[i];
      const Vec3& q = points_[(i + 1) % size_];
      const double hp = keep.above(p);
      const double hq = keep.above(q);
      if (hp <= 0) {
        kept[count++] = p;
      }
      if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) {
        kept[count++] = p + hp / (hp - hq) * (q - p);
      }
    }
    points_ = kept;
    size_ = count;
  }

  [[nodiscard]] std::span<const Vec3> corners() const {
    return std::span(points_).first(static_cast<std::size_t>(size_));
  }

private:
  std::array<Vec3, 10> points_;
  int size_;
};

} // namespace

SurfaceTree::SurfaceTree(TriangleView model) {
  std::vector<Corners> corners;
  corners.reserve(model.triangles.size());
  for (const Triangle& t : model.triangles) {
    corners.push_back({model.positions[t[0]], model.positions[t[1]], model.positions[t[2]]});
  }
  build(corners);
}

void SurfaceTree::build(std::span<const Corners> corners) {
  std::vector<Vec3> middles;
  middles.reserve(corners.size());
  for (const Corners& t : corners) {
    middles.emplace_back((t[0] + t[1] + t[2]) / 3);
  }
  std::vector<Index> order(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  struct Task {
    Index node, first, count;
  };
  std::vector<Task> tasks;
  if (!order.empty()) {
    nodes_.emplace_back();
    tasks.push_back({0, 0, static_cast<Index>(order.size())});
  }
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Box3 box;
    Box3 spread;
    for (Index i = task.first; i < task.first + task.count; ++i) {
      for (const Vec3& p : corners[order[i]]) {
        box.extend(p);
      }
      spread.extend(middles[order[i]]);
    }
    // A hair larger than the rounding of center and half.
    const double hair = 4e-16 * (box.min().cwiseAbs() + box.max().cwiseAbs()).maxCoeff();
    nodes_[task.node].center = box.center();
    nodes_[task.node].half = (box.sizes() / 2).array() + hair;
    if (task.count <= leaf_size) {
      nodes_[task.node].first = task.first;
      nodes_[task.node].count = task.count;
      continue;
    }
    Eigen::Index axis = 0;
    spread.sizes().maxCoeff(&axis);
    const Index middle = task.first + task.count / 2;
    std::nth_element(order.begin() + task.first, order.begin() + middle,
                     order.begin() + task.first + task.count, [&](Index a, Index b) {
                       return middles[a][axis] != middles[b][axis]
                                  ? middles[a][axis] < middles[b][axis]
                                  : a < b;
                     });
    const auto child = static_cast<Index>(nodes_.size());
    nodes_[task.node].first = child;
    nodes_.resize(nodes_.size() + 2);
    tasks.push_back({child + 1, middle, task.first + task.count - middle});
    tasks.push_back({child, task.first, middle - task.first});
  }
  triangles_.reserve(order.size());
  for (const Index i : order) {
    triangles_.push_back(corners[i]);
  }
}

SurfaceTree::Nearest SurfaceTree::nearest(const Vec3& p, double within, double error) const {
  Nearest best;
  const double factor = (1 + error) * (1 + error);
  double bound = within * within;
  struct Entry {
    Index node;
    double squared;
  };
  std::array<Entry, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = {0, squared_distance(nodes_[0].center, nodes_[0].half, p)};
  }
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.squared * factor >= bound) {
      continue;
    }
    const Node& node = nodes_[entry.node];
    for (Index i = node.first; i < node.first + node.count; ++i) {
      const Vec3 q = nearest_in_triangle(p, triangles_[i]);
      const double squared = (q - p).squaredNorm();
      if (squared < bound) {
        bound = squared;
        best = {0, q};
      }
    }
    if (node.count == 0) {
      const Index a = node.first;
      const Entry near{a, squared_distance(nodes_[a].center, nodes_[a].half, p)};
      const Entry far{a + 1, squared_distance(nodes_[a + 1].center, nodes_[a + 1].half, p)};
      const bool swap = far.squared < near.squared;
      stack[top++] = swap ? near : far;
      stack[top++] = swap ? far : near;
    }
  }
  if (bound < within * within) {
    best.distance = std::sqrt(bound);
  }
  return best;
}

std::optional<NearestPair> SurfaceTree::too_near(const Corners& triangle, double distance) const {
  const TriangleBound bound(triangle);
  std::array<Index, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = 0;
  }
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (bound.beyond(node.center, node.half, distance)) {
      continue;
    }
    for (Index i = node.first; i < node.first + node.count; ++i) {
      if (bound.beyond(triangles_[i], distance)) {
        continue;
      }
      const NearestPair pair = nearest_of_triangles(triangle, triangles_[i]);
      if (pair.squared < distance * distance) {
        return pair;
      }
    }
    if (node.count == 0) {
      stack[top++] = node.first + 1;
      stack[top++] = node.first;
    }
  }
  return std::nullopt;
}

std::optional<NearestPair> SurfaceTree::nearest_to(const Corners& triangle, double within) const {
  std::optional<NearestPair> best;
  const TriangleBound bound(triangle);
  std::array<Index, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = 0;
  }
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (bound.beyond(node.center, node.half, within)) {
      continue;
    }
    for (Index i = node.first; i < node.first + node.count; ++i) {
      if (bound.beyond(triangles_[i], within)) {
        continue;
      }
      const NearestPair pair = nearest_of_triangles(triangle, triangles_[i]);
      if (pair.squared < within * within) {
        best = pair;
        within = std::sqrt(pair.squared);
      }
    }
    if (node.count == 0) {
      stack[top++] = node.first + 1;
      stack[top++] = node.first;
    }
  }
  return best;
}

std::optional<SurfaceTree::Highest> SurfaceTree::highest(const HalfSpace& plane,
                                                         const std::array<HalfSpace, 3>& sides,
                                                         double least, double most) const {
  std::optional<Highest> best;
  const Vec3 up = plane.normal.cwiseAbs();
  const std::array<Vec3, 3> across = {sides[0].normal.cwiseAbs(), sides[1].normal.cwiseAbs(),
                                      sides[2].normal.cwiseAbs()};
  const HalfSpace ceiling{plane.normal, plane.offset + most};
  const auto reach = [&](const Node& node) { // the greatest height in the node, or none
    const double height = plane.above(node.center);
    const double half = up.dot(node.half);
    if (height - half > most) {
      return -std::numeric_limits<double>::infinity();
    }
    for (int i = 0; i < 3; ++i) {
      if (sides[i].above(node.center) > across[i].dot(node.half)) {
        return -std::numeric_limits<double>::infinity();
      }
    }
    return height + half;
  };
  struct Entry {
    Index node;
    double height;
  };
  std::array<Entry, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = {0, reach(nodes_[0])};
  }
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.height <= least) {
      continue;
    }
    const Node& node = nodes_[entry.node];
    for (Index i = node.first; i < node.first + node.count; ++i) {
      const Corners& t = triangles_[i];
      if (std::max({plane.above(t[0]), plane.above(t[1]), plane.above(t[2])}) <= least) {
        continue;
      }
      Clipped polygon(t);
      polygon.cut(ceiling);
      for (const HalfSpace& side : sides) {
        polygon.cut(side);
      }
      for (const Vec3& p : polygon.corners()) {
        const double height = plane.above(p);
        if (height > least) {
          least = height;
          best = {height, p};
        }
      }
    }
    if (node.count == 0) {
      const Entry a{node.first, reach(nodes_[node.first])};
      const Entry b{node.first + 1, reach(nodes_[node.first + 1])};
      const bool swap = a.height > b.height;
      stack[top++] = swap ? b : a;
      stack[top++] = swap ? a : b;
    }
  }
  return best;
}

} // namespace cagewright
