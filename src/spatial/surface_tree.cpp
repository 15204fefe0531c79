#include "spatial/surface_tree.h"

#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace cagewright {

namespace {

// Median splits divide the count by eight at every level: 2^31 triangles need 11.
constexpr int most_levels = 12;
// With seven siblings waiting at each.
constexpr int deepest = 8 * most_levels;

constexpr float rounding = frame_rounding;

// Half the size of the box of an empty slot.
constexpr float nothing = -1e30F;

Vec3 nearest_on(const Corners& t, const Vec3& p) {
  return nearest_on_triangle(p, t[0], t[1], t[2]);
}

// Lower bounds of the distance to a triangle: along the axes of its box, its normal, and the
// outward normals of its sides.
class TriangleBound {
public:
  struct Axis {
    Vec3 normal; // length one
    double low = 0;
    double high = 0;
    bool two_sided = false;
  };

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

  // True only if the other triangle is further away than the distance.
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
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]); // beside the other's plane
    const double a = n.dot(corners_[0] - t[0]);
    const double b = n.dot(corners_[1] - t[0]);
    const double c = n.dot(corners_[2] - t[0]);
    const double gap = std::max(std::min({a, b, c}), -std::max({a, b, c}));
    if (gap > 0 && gap * gap > distance * distance * n.squaredNorm()) {
      return true;
    }
    // Beyond a plane that touches this one where it is nearest to the other's middle.
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
    const Vec3 at = nearest_on(corners_, middle);
    const Vec3 away = middle - at;
    const double least = std::min({away.dot(t[0] - at), away.dot(t[1] - at), away.dot(t[2] - at)});
    return least > 0 && least * least > distance * distance * away.squaredNorm();
  }

  [[nodiscard]] std::span<const Axis> axes() const {
    return std::span(axes_).first(static_cast<std::size_t>(count_));
  }
  [[nodiscard]] const Vec3& center() const { return center_; }
  [[nodiscard]] const Vec3& half() const { return half_; }

private:
  void add(const Vec3& normal, bool two_sided) {
    const double a = normal.dot(corners_[0]);
    const double b = normal.dot(corners_[1]);
    const double c = normal.dot(corners_[2]);
    axes_[count_++] = {normal, std::min({a, b, c}), std::max({a, b, c}), two_sided};
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
  explicit Clipped(const Corners& t) : size_(3) {
    points_[0] = t[0];
    points_[1] = t[1];
    points_[2] = t[2];
  }

  void cut(const HalfSpace& keep) {
    std::array<double, 10> height;
    bool whole = true;
    for (int i = 0; i < size_; ++i) {
      height[i] = keep.above(points_[i]);
      whole = whole && height[i] <= 0;
    }
    if (whole) {
      return;
    }
    std::array<Vec3, 10> kept;
    int count = 0;
    for (int i = 0; i < size_; ++i) {
      const int next = i + 1 < size_ ? i + 1 : 0;
      const double hp = height[i];
      const double hq = height[next];
      if (hp <= 0) {
        kept[count++] = points_[i];
      }
      if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) {
        kept[count++] = points_[i] + hp / (hp - hq) * (points_[next] - points_[i]);
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
  struct Range { // of triangles in `order`
    Index first = 0;
    Index count = 0;
  };
  Box3 all;
  std::vector<Vec3> middles;
  middles.reserve(corners.size());
  for (const Corners& t : corners) {
    middles.emplace_back((t[0] + t[1] + t[2]) / 3);
    for (const Vec3& p : t) {
      all.extend(p);
    }
  }
  if (corners.empty()) {
    return;
  }
  origin_ = all.center();
  const double size = all.sizes().maxCoeff() / 2;
  scale_ = size > 0 ? 1 / size : 1;
  std::vector<Index> order(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  // The upper half of the range, after sorting its two halves along the axis of greatest spread.
  const auto cut = [&](Range& range) {
    Box3 spread;
    for (Index i = range.first; i < range.first + range.count; ++i) {
      spread.extend(middles[order[i]]);
    }
    Eigen::Index axis = 0;
    spread.sizes().maxCoeff(&axis);
    // In whole nodes of triangles: the lowest nodes are the most, and their slots are full.
    const Index half =
        range.count > width ? (range.count / 2 + width / 2) / width * width : range.count / 2;
    std::nth_element(order.begin() + range.first, order.begin() + range.first + half,
                     order.begin() + range.first + range.count, [&](Index a, Index b) {
                       return middles[a][axis] != middles[b][axis]
                                  ? middles[a][axis] < middles[b][axis]
                                  : a < b;
                     });
    const Range upper{range.first + half, range.count - half};
    range.count = half;
    return upper;
  };
  struct Task {
    Index node;
    Range range;
  };
  // Level by level, the nodes of one in parallel: their numbers do not depend on the threads.
  nodes_.emplace_back();
  std::vector<Task> tasks = {{0, {0, static_cast<Index>(order.size())}}};
  while (!tasks.empty()) {
    std::vector<std::array<Range, width>> parts(tasks.size());
    parallel_for(0, tasks.size(), 1, [&](std::size_t t) {
      std::array<Range, width>& ranges = parts[t];
      ranges[0] = tasks[t].range;
      const Index enough = ranges[0].count > width ? width : 1;
      for (int step = width / 2; step > 0; step /= 2) {
        for (int i = 0; i < width; i += 2 * step) {
          if (ranges[i].count > enough) {
            ranges[i + step] = cut(ranges[i]);
          }
        }
      }
    });
    std::vector<Task> next;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      for (int i = 0; i < width; ++i) {
        const Range& range = parts[t][i];
        Index child = range.first | leaf_bit;
        if (range.count > 1) {
          child = static_cast<Index>(nodes_.size());
          nodes_.emplace_back();
          next.push_back({child, range});
        }
        nodes_[tasks[t].node].child[i] = child;
      }
    }
    parallel_for(0, width * tasks.size(), 1, [&](std::size_t s) {
      const auto slot = static_cast<int>(s % width);
      const Range& range = parts[s / width][slot];
      set_slot(nodes_[tasks[s / width].node], slot,
               std::span(order).subspan(range.first, range.count), corners);
    });
    tasks = std::move(next);
  }
  triangles_.reserve(order.size());
  for (const Index i : order) {
    triangles_.push_back(corners[i]);
  }
  numbers_ = std::move(order);
}

// The box and the plate of a range of triangles.
void SurfaceTree::set_slot(SurfaceNode& node, int slot, std::span<const Index> range,
                           std::span<const Corners> corners) const {
  Box3 box;
  Vec3 normal = Vec3::Zero();
  for (const Index i : range) {
    const Corners& t = corners[i];
    normal += (t[1] - t[0]).cross(t[2] - t[0]);
    for (const Vec3& p : t) {
      box.extend(p);
    }
  }
  const bool none = range.empty();
  Vec3 center;
  for (int k = 0; k < 3; ++k) {
    node.center[k][slot] = none ? 0 : static_cast<float>((box.center()[k] - origin_[k]) * scale_);
    node.half[k][slot] =
        none ? nothing : static_cast<float>(box.sizes()[k] / 2 * scale_) + rounding / 4;
    center[k] = node.center[k][slot];
  }
  const double length = normal.norm();
  normal = length > 0 && std::isfinite(length) ? Vec3(normal / length) : Vec3(Vec3::UnitZ());
  for (int k = 0; k < 3; ++k) {
    node.normal[k][slot] = static_cast<float>(normal[k]);
    normal[k] = node.normal[k][slot];
  }
  double low = 0;
  double high = 0;
  double radius = 0; // squared
  bool first = true;
  for (const Index i : range) {
    for (const Vec3& p : corners[i]) {
      const Vec3 from_center = (p - origin_) * scale_ - center;
      const double height = normal.dot(from_center);
      low = first ? height : std::min(low, height);
      high = first ? height : std::max(high, height);
      radius = std::max(radius, (from_center - height * normal).squaredNorm());
      first = false;
    }
  }
  node.middle[slot] = static_cast<float>((low + high) / 2);
  node.thickness[slot] = static_cast<float>((high - low) / 2) + rounding / 4;
  node.radius[slot] = static_cast<float>(std::sqrt(radius)) + rounding / 4;
}

void SurfaceTree::to_frame(const Vec3& p, float (&result)[3]) const {
  const Vec3 q = (p - origin_) * scale_;
  for (int k = 0; k < 3; ++k) {
    result[k] = static_cast<float>(q[k]);
  }
}

// Round fine models much time goes with waiting for memory: it is asked for what comes after the
// next.
inline void SurfaceTree::prefetch(Index child) const {
  const bool is_leaf = (child & leaf_bit) != 0;
  const void* begin = is_leaf ? static_cast<const void*>(triangles_.data() + (child & ~leaf_bit))
                              : static_cast<const void*>(nodes_.data() + child);
  const std::size_t size = is_leaf ? sizeof(Corners) : sizeof(SurfaceNode);
  constexpr std::size_t line = 64;
  for (std::size_t at = 0; at < size; at += line) {
    __builtin_prefetch(static_cast<const char*>(begin) + at);
  }
}

SurfaceTree::Nearest SurfaceTree::nearest(const Vec3& p, double within, double error) const {
  Nearest best;
  double bound = within * within;
  float q[3];
  to_frame(p, q);
  // Squared distances in the frame beyond which a box cannot hold what is sought.
  const double shrink = scale_ * scale_ / ((1 + error) * (1 + error));
  const auto limit = [&] {
    const double length = std::sqrt(bound * shrink) + rounding;
    return static_cast<float>(std::min(length * length, 1e30));
  };
  if (nodes_.empty()) {
    return best;
  }
  // The nodes from the root to the present one, with what is left of each.
  struct alignas(32) Level {
    SurfaceNode::Lanes squared;
    const SurfaceNode* node;
  };
  std::array<Level, most_levels> path;
  int level = 0;
  float most = limit();
  path[0].node = nodes_.data();
  int next = nearest_child(*path[0].node, q, most, path[0].squared);
  for (;;) {
    Level& at = path[level];
    if (next < 0) {
      if (level == 0) {
        break;
      }
      --level;
      next = least_below(path[level].squared, most);
      continue;
    }
    at.squared[next] = std::numeric_limits<float>::infinity();
    const Index child = at.node->child[next];
    if ((child & leaf_bit) == 0) {
      Level& below = path[++level];
      below.node = &nodes_[child];
      if ((below.node->child[0] & leaf_bit) != 0) {
        for (const Index triangle : below.node->child) {
          prefetch(triangle);
        }
      }
      next = nearest_child(*below.node, q, most, below.squared);
      continue;
    }
    const Vec3 point = nearest_on(triangles_[child & ~leaf_bit], p);
    const double squared = (point - p).squaredNorm();
    if (squared < bound) {
      bound = squared;
      best.point = point;
      best.triangle = numbers_[child & ~leaf_bit];
      most = limit();
    }
    next = least_below(at.squared, most);
  }
  if (bound < within * within) {
    best.distance = std::sqrt(bound);
  }
  return best;
}

// Calls visit(model triangle) -> double for all that may be within the distance, which from then on
// is what visit returns.
template <class Visit>
void SurfaceTree::visit_near(const Corners& triangle, double within, Visit visit) const {
  const TriangleBound bound(triangle);
  SlabQuery query{};
  to_frame(bound.center(), query.center);
  for (int k = 0; k < 3; ++k) {
    query.half[k] = length_in_frame(bound.half()[k]);
  }
  for (const TriangleBound::Axis& axis : bound.axes()) {
    SlabQuery::Slab& slab = query.slab[query.count++];
    for (int k = 0; k < 3; ++k) {
      slab.normal[k] = static_cast<float>(axis.normal[k]);
    }
    const double shift = axis.normal.dot(origin_);
    slab.high = static_cast<float>((axis.high - shift) * scale_);
    slab.low = axis.two_sided ? static_cast<float>((axis.low - shift) * scale_) : -1e30F;
  }
  std::array<Index, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = 0;
  }
  while (top > 0) {
    const Index child = stack[--top];
    if ((child & leaf_bit) != 0) {
      const Corners& other = triangles_[child & ~leaf_bit];
      if (!bound.beyond(other, within)) {
        within = visit(other);
        if (within <= 0) {
          return;
        }
      }
      continue;
    }
    const SurfaceNode& node = nodes_[child];
    const float reach = length_in_frame(within) + rounding;
    for (std::uint32_t set = children_within(node, query, reach); set != 0;) {
      const int i = std::bit_width(set) - 1;
      stack[top++] = node.child[i];
      prefetch(node.child[i]);
      set ^= std::uint32_t{1} << i;
    }
  }
}

std::optional<ClosestPoints> SurfaceTree::too_near(const Corners& triangle, double distance) const {
  std::optional<ClosestPoints> found;
  visit_near(triangle, distance, [&](const Corners& other) {
    const ClosestPoints pair = triangle_triangle_closest(triangle.at, other.at);
    if (pair.distance < distance) {
      found = pair;
      return 0.0; // enough
    }
    return distance;
  });
  return found;
}

std::optional<ClosestPoints> SurfaceTree::nearest_to(const Corners& triangle, double within) const {
  std::optional<ClosestPoints> best;
  double least = within;
  visit_near(triangle, within, [&](const Corners& other) {
    const ClosestPoints pair = triangle_triangle_closest(triangle.at, other.at);
    if (pair.distance < least) {
      best = pair;
      least = pair.distance;
    }
    return least;
  });
  return best;
}

std::optional<SurfaceTree::Highest> SurfaceTree::highest(const HalfSpace& plane,
                                                         const std::array<HalfSpace, 3>& sides,
                                                         double least, double most,
                                                         double error) const {
  std::optional<Highest> best;
  const double floor = least;
  const HalfSpace ceiling{plane.normal, plane.offset + most};
  PrismQuery query{};
  for (int k = 0; k < 4; ++k) {
    const HalfSpace& h = k == 0 ? plane : sides[k - 1];
    for (int m = 0; m < 3; ++m) {
      query.plane[k].normal[m] = static_cast<float>(h.normal[m]);
    }
    query.plane[k].offset = static_cast<float>((h.offset - h.normal.dot(origin_)) * scale_);
  }
  query.upper = length_in_frame(most) + rounding;
  float lower = length_in_frame(least) - rounding;
  struct Entry {
    float height;
    Index child;
  };
  std::array<Entry, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = {1e30F, 0};
  }
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.height <= lower) {
      continue;
    }
    if ((entry.child & leaf_bit) != 0) {
      const Corners& t = triangles_[entry.child & ~leaf_bit];
      const double top_corner = std::max({plane.above(t[0]), plane.above(t[1]), plane.above(t[2])});
      if (top_corner <= least) {
        continue;
      }
      const bool beside = std::any_of(sides.begin(), sides.end(), [&](const HalfSpace& side) {
        return side.above(t[0]) > 0 && side.above(t[1]) > 0 && side.above(t[2]) > 0;
      });
      if (beside) {
        continue;
      }
      Clipped polygon(t);
      if (top_corner > most) {
        polygon.cut(ceiling);
      }
      for (const HalfSpace& side : sides) {
        polygon.cut(side);
      }
      for (const Vec3& p : polygon.corners()) {
        const double height = plane.above(p);
        if (height > least) {
          least = height;
          lower = length_in_frame(least + error * (least - floor)) - rounding;
          best = {height, p};
        }
      }
      continue;
    }
    const SurfaceNode& node = nodes_[entry.child];
    SurfaceNode::Lanes height;
    const int begin = top;
    for (std::uint32_t set = children_above(node, query, lower, height); set != 0; set &= set - 1) {
      const int i = std::countr_zero(set);
      int at = top++; // the highest last on the stack: it is looked at next
      for (; at > begin && stack[at - 1].height > height[i]; --at) {
        stack[at] = stack[at - 1];
      }
      stack[at] = {height[i], node.child[i]};
      prefetch(node.child[i]);
    }
  }
  return best;
}

std::vector<SurfaceTree::Relief> SurfaceTree::relief(const Corners& triangle, int cells,
                                                     double least, double most) const {
  const Vec3 ab = triangle[1] - triangle[0];
  const Vec3 ac = triangle[2] - triangle[0];
  const Vec3 n = ab.cross(ac).normalized();
  const Vec3 to_b = ac.cross(n) / ab.dot(ac.cross(n));
  const Vec3 to_c = n.cross(ab) / ac.dot(n.cross(ab));
  const auto flat = [&](const Vec3& p) { // its place in the triangle, in cells, and its height
    const Vec3 d = p - triangle[0];
    return Vec3(cells * to_b.dot(d), cells * to_c.dot(d), n.dot(d));
  };
  // Cells in a square grid, two to a square; those beyond the diagonal can hold nothing.
  constexpr double never = std::numeric_limits<double>::infinity();
  std::array<Relief, 2 * most_cells * most_cells> best;
  std::array<double, 2 * most_cells * most_cells> heights;
  const auto number = [&](int i, int j, int upper) { return 2 * (i * most_cells + j) + upper; };
  heights.fill(never);
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; i + j < cells; ++j) {
      heights[number(i, j, 0)] = least;
      heights[number(i, j, 1)] = i + j + 1 < cells ? least : never;
    }
  }
  struct Range { // of squares
    int low[2];
    int high[2];
  };
  const auto to_range = [&](double low_b, double high_b, double low_c, double high_c) {
    const double last = cells - 1;
    return Range{{static_cast<int>(std::clamp(low_b, 0.0, last)),
                  static_cast<int>(std::clamp(low_c, 0.0, last))},
                 {static_cast<int>(std::clamp(high_b, 0.0, last)),
                  static_cast<int>(std::clamp(high_c, 0.0, last))}};
  };
  // True if some cell of the range may still get something of this height.
  const auto wanted = [&](const Range& r, double height) {
    for (int i = r.low[0]; i <= r.high[0]; ++i) {
      for (int j = r.low[1]; j <= r.high[1]; ++j) {
        if (heights[number(i, j, 0)] < height || heights[number(i, j, 1)] < height) {
          return true;
        }
      }
    }
    return false;
  };
  const auto offer = [&](int cell, const Vec3& p) {
    if (p.z() > heights[cell] && p.z() <= most) {
      heights[cell] = p.z();
      best[cell] = {p.x() / cells, p.y() / cells, p.z()};
    }
  };
  const auto in_cell = [&](const Corners& at, int i, int j, double sign) {
    return std::all_of(at.begin(), at.end(), [&](const Vec3& p) {
      const double x = sign > 0 ? p.x() - i : i + 1 - p.x();
      const double y = sign > 0 ? p.y() - j : j + 1 - p.y();
      return x >= 0 && y >= 0 && x + y <= 1;
    });
  };
  const auto add = [&](const Corners& t) {
    const Corners at = {flat(t[0]), flat(t[1]), flat(t[2])};
    const Vec3 low = at[0].cwiseMin(at[1]).cwiseMin(at[2]);
    const Vec3 high = at[0].cwiseMax(at[1]).cwiseMax(at[2]);
    const std::array<double, 3> sums = {at[0].x() + at[0].y(), at[1].x() + at[1].y(),
                                        at[2].x() + at[2].y()};
    const double least_sum = std::min({sums[0], sums[1], sums[2]});
    const double most_sum = std::max({sums[0], sums[1], sums[2]});
    const bool beside = high.x() < 0 || high.y() < 0 || least_sum > cells;
    const Range r = to_range(low.x(), high.x(), low.y(), high.y());
    if (beside || low.z() > most || !wanted(r, high.z())) {
      return;
    }
    for (int i = r.low[0]; i <= r.high[0]; ++i) {
      for (int j = r.low[1]; j <= r.high[1]; ++j) {
        for (int upper = 0; upper < 2; ++upper) {
          const int cell = number(i, j, upper);
          if (heights[cell] >= high.z()) {
            continue;
          }
          const double sign = upper == 0 ? 1 : -1;
          if (upper == 0 ? least_sum > i + j + 1 : most_sum < i + j + 1) {
            continue; // beyond the diagonal
          }
          const bool inside = high.z() <= most && in_cell(at, i, j, sign);
          if (inside) {
            for (const Vec3& p : at) {
              offer(cell, p);
            }
            return; // of no other
          }
          Clipped polygon(at);
          if (high.z() > most) {
            polygon.cut({Vec3(0, 0, 1), most});
          }
          polygon.cut({Vec3(-sign, 0, 0), upper == 0 ? -i : i + 1.0});
          polygon.cut({Vec3(0, -sign, 0), upper == 0 ? -j : j + 1.0});
          polygon.cut({Vec3(sign, sign, 0), sign * (i + j + 1)});
          for (const Vec3& p : polygon.corners()) {
            offer(cell, p);
          }
        }
      }
    }
  };
  // The linear functions in the frame, in single precision.
  const auto to_float = [&](const Vec3& slope, double offset) {
    ColumnQuery::Linear f{};
    for (int k = 0; k < 3; ++k) {
      f.slope[k] = static_cast<float>(slope[k] / scale_);
      f.slack += rounding * std::abs(f.slope[k]);
    }
    f.length = static_cast<float>(slope.norm() / scale_);
    f.offset = static_cast<float>(offset + slope.dot(origin_ - triangle[0]));
    f.slack += rounding * std::abs(f.offset);
    return f;
  };
  const ColumnQuery query{{to_float(n, 0), to_float(cells * to_b, 0), to_float(cells * to_c, 0),
                           to_float(-cells * (to_b + to_c), cells)},
                          static_cast<float>(least),
                          static_cast<float>(most)};
  struct Entry {
    float height;
    float low_b, high_b, low_c, high_c;
    Index child;
  };
  std::array<Entry, deepest> stack;
  int top = 0;
  if (!nodes_.empty()) {
    stack[top++] = {1e30F, 0, 1e30F, 0, 1e30F, 0};
  }
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!wanted(to_range(entry.low_b, entry.high_b, entry.low_c, entry.high_c), entry.height)) {
      continue;
    }
    if ((entry.child & leaf_bit) != 0) {
      add(triangles_[entry.child & ~leaf_bit]);
      continue;
    }
    const SurfaceNode& node = nodes_[entry.child];
    ColumnRanges r;
    const int begin = top;
    for (std::uint32_t set = children_in_column(node, query, r); set != 0; set &= set - 1) {
      const int i = std::countr_zero(set);
      int at = top++; // the highest last on the stack: it is looked at next
      for (; at > begin && stack[at - 1].height > r.height[i]; --at) {
        stack[at] = stack[at - 1];
      }
      stack[at] = {r.height[i], r.low_b[i], r.high_b[i], r.low_c[i], r.high_c[i], node.child[i]};
      prefetch(node.child[i]);
    }
  }
  std::vector<Relief> result;
  for (std::size_t cell = 0; cell < heights.size(); ++cell) {
    if (heights[cell] > least && heights[cell] < never) {
      result.push_back(best[cell]);
    }
  }
  return result;
}

} // namespace cagewright
