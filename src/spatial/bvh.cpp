#include "spatial/bvh.h"

#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cagewright {
namespace {

using Lanes = Eigen::Array4f;

/// A triangle while the hierarchy is built: its box, with its index in the fourth lane.
struct Item {
  Lanes low;
  Lanes high;

  [[nodiscard]] Index id() const { return std::bit_cast<Index>(low[3]); }
  [[nodiscard]] float twice_middle(int axis) const { return low[axis] + high[axis]; }
};

struct LaneBox {
  Lanes low = Lanes::Constant(HUGE_VALF);
  Lanes high = Lanes::Constant(-HUGE_VALF);

  void extend(const Lanes& l, const Lanes& h) {
    low = low.min(l);
    high = high.max(h);
  }
  void extend(const LaneBox& box) { extend(box.low, box.high); }
  [[nodiscard]] float half_area() const {
    const Lanes d = high - low;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

// Outward by two units in the last place: more than the conversion and the arithmetic before it
// can have lost. (std::nextafter is a call.)
float round_up(double x) {
  const auto nearest = static_cast<float>(std::clamp(x, -1e30, 1e30));
  return nearest + (std::abs(nearest) * 0x1.0p-22F + 1e-37F);
}
float round_down(double x) {
  return -round_up(-x);
}

/// A bound of squared distances in the frame, rounded so that nothing within it is lost.
float bound_of(double distance_squared, double scale) {
  const double squared = distance_squared * scale * scale;
  return squared < 1e30 ? round_up(squared) : HUGE_VALF;
}

bool is_finite(const Vec3 (&t)[3]) {
  return t[0].allFinite() && t[1].allFinite() && t[2].allFinite();
}

/// Lower bounds of the squared distances from a box to the four children of a node. Rounding of
/// the float arithmetic is below the part taken off.
template <class Node, class Box>
void squared_distances(const Node& node, const Box& box, float (&result)[4]) {
  const auto gap = [&](int axis) -> Lanes {
    const auto low = Lanes::Map(node.low[axis]);
    const auto high = Lanes::Map(node.high[axis]);
    return (low - box.high[axis]).max(box.low[axis] - high).max(0.0F);
  };
  Lanes::Map(result) = (gap(0).square() + gap(1).square() + gap(2).square()) * 0.999999F;
}

/// A node or triangle yet to be looked at, and how near it can be at best.
struct Waiting {
  float squared;
  Index child;
};

} // namespace

/// Splits the triangles top-down by the surface area heuristic over bins of their middles
/// (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
class BvhBuilder {
public:
  explicit BvhBuilder(TriangleBvh& bvh) : bvh_(bvh) {}

  void build(TriangleView mesh) {
    make_items(mesh);
    if (items_.empty()) {
      return;
    }
    // The top of the tree on this thread, the subtrees below it as jobs. Which they are depends
    // on the mesh alone.
    subtree_limit_ = std::max<std::size_t>(items_.size() / 32, 2048);
    add_node(bvh_.nodes_, 0, items_.size(), 0, true);
    std::vector<std::vector<Node>> subtrees(jobs_.size());
    parallel_for(0, jobs_.size(), 1, [&](std::size_t i) {
      subtrees[i].reserve((jobs_[i].end - jobs_[i].begin) / 2 + 1);
      add_node(subtrees[i], jobs_[i].begin, jobs_[i].end, jobs_[i].depth, false);
    });
    append(subtrees);
  }

private:
  using Node = TriangleBvh::Node;
  static constexpr Index leaf_bit = TriangleBvh::leaf_bit;
  static constexpr int bins = 16;
  static constexpr std::size_t few = 16; // so few are halved at the middle
  static constexpr int depth_limit = 24; // below, halving too: the queries' stacks are bounded

  struct Range {
    std::size_t begin;
    std::size_t end;
  };
  struct Job {
    std::size_t begin;
    std::size_t end;
    int depth;
    Index node; // where its root hangs
    int slot;
  };

  void make_items(TriangleView mesh) {
    const std::size_t count = mesh.triangles.size();
    bvh_.corners_.resize(count);
    items_.resize(count);
    const auto is_finite = [&](const Triangle& t) {
      return mesh.positions[t[0]].allFinite() && mesh.positions[t[1]].allFinite() &&
             mesh.positions[t[2]].allFinite();
    };
    Box3 box;
    bool all_finite = true;
    for (const Triangle& t : mesh.triangles) {
      if (is_finite(t)) {
        box.extend(mesh.positions[t[0]]);
        box.extend(mesh.positions[t[1]]);
        box.extend(mesh.positions[t[2]]);
      } else {
        all_finite = false;
      }
    }
    if (!box.isEmpty()) {
      bvh_.origin_ = box.center();
      const double half = box.sizes().maxCoeff() / 2;
      bvh_.scale_ = half > 0 && std::isfinite(half) ? std::ldexp(1.0, -std::ilogb(half) - 1) : 1;
    }
    parallel_for(0, count, 4096, [&](std::size_t i) {
      const Triangle& t = mesh.triangles[i];
      Vec3(&at)[3] = bvh_.corners_[i].at;
      at[0] = mesh.positions[t[0]];
      at[1] = mesh.positions[t[1]];
      at[2] = mesh.positions[t[2]];
      const auto frame = bvh_.to_frame(at[0].cwiseMin(at[1]).cwiseMin(at[2]),
                                       at[0].cwiseMax(at[1]).cwiseMax(at[2]));
      Item& item = items_[i];
      item.low = Lanes(frame.low[0], frame.low[1], frame.low[2],
                       std::bit_cast<float>(static_cast<Index>(i)));
      item.high = Lanes(frame.high[0], frame.high[1], frame.high[2], 0);
    });
    if (!all_finite) {
      std::erase_if(items_,
                    [&](const Item& item) { return !is_finite(mesh.triangles[item.id()]); });
    }
  }

  /// Adds the node over [begin, end) and what hangs below it; \returns its index in `nodes`.
  Index add_node(std::vector<Node>& nodes, std::size_t begin, std::size_t end, int depth,
                 bool may_defer) {
    std::array<Range, 4> children;
    const int count = split_in_four(begin, end, depth, children);
    const auto index = static_cast<Index>(nodes.size());
    nodes.emplace_back();
    for (int i = 0; i < 4; ++i) {
      if (i >= count) {
        set_child(nodes[index], i, LaneBox(), leaf_bit);
        continue;
      }
      const Range range = children[i];
      LaneBox box;
      for (std::size_t k = range.begin; k < range.end; ++k) {
        box.extend(items_[k].low, items_[k].high);
      }
      set_child(nodes[index], i, box, leaf_bit | items_[range.begin].id());
      if (range.end - range.begin == 1) {
        continue;
      }
      if (may_defer && range.end - range.begin <= subtree_limit_) {
        jobs_.push_back({range.begin, range.end, depth + 1, index, i});
      } else {
        const Index child = add_node(nodes, range.begin, range.end, depth + 1, may_defer);
        nodes[index].child[i] = child;
      }
    }
    return index;
  }

  static void set_child(Node& node, int slot, const LaneBox& box, Index child) {
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][slot] = box.low[axis];
      node.high[axis][slot] = box.high[axis];
    }
    node.child[slot] = child;
  }

  int split_in_four(std::size_t begin, std::size_t end, int depth, std::array<Range, 4>& children) {
    int count = 0;
    if (end - begin <= 4) {
      for (std::size_t k = begin; k < end; ++k) {
        children[count++] = {k, k + 1};
      }
      return count;
    }
    const std::size_t middle = split(begin, end, depth);
    for (const Range half : {Range{begin, middle}, Range{middle, end}}) {
      if (half.end - half.begin == 1) {
        children[count++] = half;
      } else {
        const std::size_t quarter = split(half.begin, half.end, depth);
        children[count++] = {half.begin, quarter};
        children[count++] = {quarter, half.end};
      }
    }
    return count;
  }

  std::size_t split(std::size_t begin, std::size_t end, int depth) {
    Lanes low = Lanes::Constant(HUGE_VALF);
    Lanes high = Lanes::Constant(-HUGE_VALF);
    for (std::size_t k = begin; k < end; ++k) {
      const Lanes middle = items_[k].low + items_[k].high;
      low = low.min(middle);
      high = high.max(middle);
    }
    int axis = 0;
    (high - low).head<3>().maxCoeff(&axis);
    const float extent = high[axis] - low[axis];
    if (end - begin <= few || depth > depth_limit || extent <= 0) {
      return split_at_middle(begin, end, axis);
    }
    return split_by_area(begin, end, axis, low[axis], extent);
  }

  std::size_t split_at_middle(std::size_t begin, std::size_t end, int axis) {
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t k) { return items_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
      const float at_a = a.twice_middle(axis);
      const float at_b = b.twice_middle(axis);
      return at_a != at_b ? at_a < at_b : a.id() < b.id();
    });
    return middle;
  }

  std::size_t split_by_area(std::size_t begin, std::size_t end, int axis, float low, float extent) {
    std::array<LaneBox, bins> boxes;
    std::array<std::size_t, bins> counts{};
    const float factor = static_cast<float>(bins) * 0.99999F / extent;
    const auto bin_of = [&](const Item& item) {
      return static_cast<int>((item.twice_middle(axis) - low) * factor);
    };
    for (std::size_t k = begin; k < end; ++k) {
      const int bin = std::clamp(bin_of(items_[k]), 0, bins - 1);
      boxes[bin].extend(items_[k].low, items_[k].high);
      ++counts[bin];
    }
    std::array<float, bins> right_cost{};
    LaneBox box;
    std::size_t count = 0;
    for (int bin = bins - 1; bin > 0; --bin) {
      box.extend(boxes[bin]);
      count += counts[bin];
      right_cost[bin] = count > 0 ? box.half_area() * static_cast<float>(count) : 0;
    }
    box = {};
    count = 0;
    int best = 1;
    float best_cost = HUGE_VALF;
    for (int bin = 1; bin < bins; ++bin) {
      box.extend(boxes[bin - 1]);
      count += counts[bin - 1];
      const float cost = box.half_area() * static_cast<float>(count) + right_cost[bin];
      if (count > 0 && count < end - begin && cost < best_cost) {
        best_cost = cost;
        best = bin;
      }
    }
    const auto at = [&](std::size_t k) { return items_.begin() + static_cast<std::ptrdiff_t>(k); };
    const auto middle = std::partition(at(begin), at(end), [&](const Item& item) {
      return std::clamp(bin_of(item), 0, bins - 1) < best;
    });
    const auto result = static_cast<std::size_t>(middle - items_.begin());
    return result == begin || result == end ? split_at_middle(begin, end, axis) : result;
  }

  void append(const std::vector<std::vector<Node>>& subtrees) {
    std::size_t total = bvh_.nodes_.size();
    for (const std::vector<Node>& subtree : subtrees) {
      total += subtree.size();
    }
    bvh_.nodes_.reserve(total);
    for (std::size_t i = 0; i < subtrees.size(); ++i) {
      const auto offset = static_cast<Index>(bvh_.nodes_.size());
      bvh_.nodes_[jobs_[i].node].child[jobs_[i].slot] = offset;
      for (Node node : subtrees[i]) {
        for (Index& child : node.child) {
          child += (child & leaf_bit) == 0 ? offset : 0;
        }
        bvh_.nodes_.push_back(node);
      }
    }
  }

  TriangleBvh& bvh_;
  std::vector<Item> items_;
  std::vector<Job> jobs_;
  std::size_t subtree_limit_ = 0;
};

TriangleBvh::TriangleBvh(TriangleView mesh) {
  BvhBuilder(*this).build(mesh);
}

TriangleBvh::FloatBox TriangleBvh::to_frame(const Vec3& low, const Vec3& high) const {
  FloatBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = round_down((low[axis] - origin_[axis]) * scale_);
    box.high[axis] = round_up((high[axis] - origin_[axis]) * scale_);
  }
  return box;
}

TriangleBvh::FloatSegment TriangleBvh::to_frame_segment(const Vec3& p, const Vec3& q) const {
  // Cut to the frame's cube first: floats are precise enough only near it.
  const Vec3 from = (p - origin_) * scale_;
  const Vec3 along = (q - p) * scale_;
  double enter = 0;
  double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double wall = 1.01;
    if (along[axis] != 0) {
      const double t0 = (-wall - from[axis]) / along[axis];
      const double t1 = (wall - from[axis]) / along[axis];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    } else if (std::abs(from[axis]) > wall) {
      enter = 2;
    }
  }
  FloatSegment segment;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = along[axis] * (leave - enter) / 2;
    const double middle = from[axis] + along[axis] * (enter + leave) / 2;
    segment.middle[axis] = enter <= leave ? static_cast<float>(middle) : 1e30F;
    segment.signed_half[axis] = enter <= leave ? static_cast<float>(half) : 0;
    segment.half[axis] = std::abs(segment.signed_half[axis]);
  }
  return segment;
}

unsigned TriangleBvh::overlap_mask(const Node& node, const FloatSegment& segment) {
  // Separating axes of a box and a segment; the slack covers the rounding of coordinates up to 1.
  constexpr float slack = 4e-6F;
  unsigned mask = 0;
  for (int i = 0; i < 4; ++i) {
    std::array<float, 3> h;
    std::array<float, 3> t;
    bool meets = node.low[0][i] <= node.high[0][i];
    for (int axis = 0; axis < 3; ++axis) {
      h[axis] = (node.high[axis][i] - node.low[axis][i]) / 2 + slack;
      t[axis] = (node.high[axis][i] + node.low[axis][i]) / 2 - segment.middle[axis];
      meets = meets && std::abs(t[axis]) <= h[axis] + segment.half[axis];
    }
    for (int u = 0; meets && u < 3; ++u) {
      const int v = u == 2 ? 0 : u + 1;
      meets = std::abs(t[u] * segment.signed_half[v] - t[v] * segment.signed_half[u]) <=
              h[u] * segment.half[v] + h[v] * segment.half[u];
    }
    mask |= static_cast<unsigned>(meets) << static_cast<unsigned>(i);
  }
  return mask;
}

NearestPoint TriangleBvh::nearest(const Vec3& p, double max_distance) const {
  NearestPoint best;
  if (nodes_.empty() || !p.allFinite()) {
    return best;
  }
  const FloatBox query = to_frame(p, p);
  double best_squared = max_distance * max_distance;
  float bound = bound_of(best_squared, scale_);
  std::array<Waiting, stack_size> stack;
  int top = 0;
  stack[top++] = {0, 0};
  while (top > 0) {
    const Waiting waiting = stack[--top];
    if (waiting.squared > bound) {
      continue;
    }
    if ((waiting.child & leaf_bit) != 0) {
      const Index t = waiting.child & ~leaf_bit;
      const Vec3(&c)[3] = corners_[t].at;
      const Vec3 x = nearest_on_triangle(p, c[0], c[1], c[2]);
      if (const double squared = (p - x).squaredNorm(); squared <= best_squared) {
        if (squared < best_squared || !best) {
          best.point = x;
          best.triangle = t;
        }
        best_squared = squared;
        bound = bound_of(best_squared, scale_);
      }
      continue;
    }
    const Node& node = nodes_[waiting.child];
    float squared[4];
    squared_distances(node, query, squared);
    const int base = top;
    for (int i = 0; i < 4; ++i) {
      if (squared[i] <= bound) {
        // The nearest comes to lie on top.
        int k = top++;
        for (; k > base && stack[k - 1].squared < squared[i]; --k) {
          stack[k] = stack[k - 1];
        }
        stack[k] = {squared[i], node.child[i]};
      }
    }
  }
  if (best) {
    best.distance = std::sqrt(best_squared);
  }
  return best;
}

RayHit TriangleBvh::first_hit(const Vec3& origin, const Vec3& direction,
                              double max_distance) const {
  RayHit hit;
  const double length = direction.norm();
  if (nodes_.empty() || !(length > 0) || !std::isfinite(length) || !origin.allFinite()) {
    return hit;
  }
  // No farther than the far side of the frame's cube.
  const double reach = std::min(max_distance, ((origin - origin_).norm() + 2 / scale_) / length);
  visit_segment(origin, origin + reach * direction, [&](Index t) {
    // Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
    const Vec3(&c)[3] = corners_[t].at;
    const Vec3 ab = c[1] - c[0];
    const Vec3 ac = c[2] - c[0];
    const Vec3 normal = direction.cross(ac);
    const double det = ab.dot(normal);
    const Vec3 from = origin - c[0];
    const double u = from.dot(normal) / det;
    const Vec3 q = from.cross(ab);
    const double v = direction.dot(q) / det;
    const double distance = ac.dot(q) / det;
    // Comparisons that a determinant of zero (NaN) fails.
    if (u >= 0 && v >= 0 && u + v <= 1 && distance >= 0 && distance <= reach &&
        (distance < hit.distance || (distance == hit.distance && t < hit.triangle))) {
      hit = {distance, t};
    }
    return true;
  });
  return hit;
}

namespace {

Box3 box_of(const Vec3 (&t)[3]) {
  Box3 box(t[0]);
  box.extend(t[1]);
  box.extend(t[2]);
  return box;
}

std::vector<std::pair<Index, Index>> pairs_from(const TriangleBvh& a, const TriangleBvh& b,
                                                bool only_rising) {
  constexpr std::size_t block = 256;
  using Pairs = std::vector<std::pair<Index, Index>>;
  return parallel_reduce_ordered(
      0, a.triangle_count(), block, Pairs(),
      [&](std::size_t first, std::size_t last) {
        Pairs pairs;
        for (std::size_t k = first; k < last; ++k) {
          const auto i = static_cast<Index>(k);
          if (!is_finite(a.corners(i))) {
            continue;
          }
          const auto begin = static_cast<std::ptrdiff_t>(pairs.size());
          b.visit_box(box_of(a.corners(i)), [&](Index j) {
            if (!only_rising || j > i) {
              pairs.emplace_back(i, j);
            }
            return true;
          });
          std::sort(pairs.begin() + begin, pairs.end());
        }
        return pairs;
      },
      [](Pairs& all, const Pairs& part) { all.insert(all.end(), part.begin(), part.end()); });
}

} // namespace

std::vector<std::pair<Index, Index>> overlapping_pairs(const TriangleBvh& a, const TriangleBvh& b) {
  return pairs_from(a, b, false);
}

std::vector<std::pair<Index, Index>> overlapping_pairs(const TriangleBvh& mesh) {
  return pairs_from(mesh, mesh, true);
}

namespace {

/// True when all of t lies farther than `distance` from the plane of `face`, on one side: then it
/// is farther from the face. Cheap, and enough for most triangles under the box of a large face.
bool is_beyond_plane(const Vec3 (&t)[3], const Vec3 (&face)[3], double distance) {
  const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double far = distance * normal.norm() * (1 + 1e-9);
  const double a = normal.dot(t[0] - face[0]);
  const double b = normal.dot(t[1] - face[0]);
  const double c = normal.dot(t[2] - face[0]);
  return (a > far && b > far && c > far) || (a < -far && b < -far && c < -far);
}

MeshDistance no_distance(double max_distance) {
  MeshDistance none;
  none.distance = max_distance;
  return none;
}

} // namespace

MeshDistance mesh_distance(const TriangleBvh& a, const TriangleBvh& b, double max_distance) {
  const MeshDistance none = no_distance(max_distance);
  if (a.empty() || b.empty()) {
    return none;
  }
  if (a.triangle_count() < b.triangle_count()) {
    MeshDistance swapped = mesh_distance(b, a, max_distance);
    std::swap(swapped.on_a, swapped.on_b);
    std::swap(swapped.triangle_a, swapped.triangle_b);
    return swapped;
  }
  // A first bound from a few corners, so that most triangles of the larger mesh are dismissed by
  // the top of the other's hierarchy.
  double bound = max_distance;
  const std::size_t step = std::max<std::size_t>(a.triangle_count() / 256, 1);
  for (std::size_t i = 0; i < a.triangle_count(); i += step) {
    bound = std::min(bound, b.nearest(a.corners(static_cast<Index>(i))[0], bound).distance);
  }
  constexpr std::size_t block = 512;
  return parallel_reduce_ordered(
      0, a.triangle_count(), block, none,
      [&](std::size_t first, std::size_t last) {
        MeshDistance best = none;
        best.distance = bound;
        for (std::size_t i = first; i < last; ++i) {
          b.improve(best, a.corners(static_cast<Index>(i)), static_cast<Index>(i));
        }
        return best;
      },
      [](MeshDistance& best, const MeshDistance& part) {
        if (part.triangle_a != NearestPoint::none &&
            (part.distance < best.distance || best.triangle_a == NearestPoint::none)) {
          best = part;
        }
      });
}

void TriangleBvh::improve(MeshDistance& best, const Vec3 (&t)[3], Index index) const {
  if (!is_finite(t)) {
    return;
  }
  const Box3 box = box_of(t);
  const FloatBox query = to_frame(box.min(), box.max());
  float bound = bound_of(best.distance * best.distance, scale_);
  std::array<Waiting, stack_size> stack;
  int top = 0;
  stack[top++] = {0, 0};
  while (top > 0) {
    const Waiting waiting = stack[--top];
    if (waiting.squared > bound) {
      continue;
    }
    if ((waiting.child & leaf_bit) != 0) {
      const Index other = waiting.child & ~leaf_bit;
      const Vec3(&corners)[3] = corners_[other].at;
      if (is_beyond_plane(t, corners, best.distance)) {
        continue;
      }
      const ClosestPoints closest = triangle_triangle_closest(t, corners);
      if (closest.distance < best.distance ||
          (closest.distance == best.distance && best.triangle_a == NearestPoint::none)) {
        static_cast<ClosestPoints&>(best) = closest;
        best.triangle_a = index;
        best.triangle_b = other;
        bound = bound_of(best.distance * best.distance, scale_);
      }
      continue;
    }
    const Node& node = nodes_[waiting.child];
    float squared[4];
    squared_distances(node, query, squared);
    for (int i = 0; i < 4; ++i) {
      if (squared[i] <= bound) {
        stack[top++] = {squared[i], node.child[i]};
      }
    }
  }
}

} // namespace cagewright
