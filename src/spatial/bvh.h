/// \file
/// A hierarchy of boxes over triangles: nearest points, overlaps, rays, distances.
#pragma once

#include "spatial/distance.h"
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace cagewright {

/// The point of a mesh that is nearest to a query.
struct NearestPoint {
  static constexpr Index none = std::numeric_limits<Index>::max();

  double distance = std::numeric_limits<double>::infinity();
  Vec3 point = Vec3::Zero();
  Index triangle = none; ///< none: nothing as near as asked for

  explicit operator bool() const { return triangle != none; }
};

/// Where a ray first meets a mesh.
struct RayHit {
  double distance = std::numeric_limits<double>::infinity(); ///< in lengths of the direction
  Index triangle = NearestPoint::none;

  explicit operator bool() const { return triangle != NearestPoint::none; }
};

/// The nearest points of two meshes, and the triangles they lie on.
struct MeshDistance : ClosestPoints {
  Index triangle_a = NearestPoint::none;
  Index triangle_b = NearestPoint::none;
};

/// A hierarchy of boxes over T triangles, four children to a node, boxes in single precision
/// rounded outward. It keeps its own copy of the triangles: the mesh may go once it is built.
///
/// All queries are const, allocate nothing and may run on any number of threads at once. Every
/// index given or taken is that of the triangle in the mesh. Triangles with a corner that is not
/// finite are left out.
///
/// Cost: building O(T log T), in parallel, the same on any number of threads; 120 bytes a triangle.
class TriangleBvh {
public:
  TriangleBvh() = default;
  explicit TriangleBvh(TriangleView mesh);

  [[nodiscard]] std::size_t triangle_count() const { return corners_.size(); }
  [[nodiscard]] bool empty() const { return nodes_.empty(); }

  /// The corners of triangle t.
  [[nodiscard]] const Vec3 (&corners(Index t) const)[3] { return corners_[t].at; }

  /// The point of the mesh nearest to p, if it is within max_distance. Of several equally near one
  /// is chosen, always the same.
  [[nodiscard]] NearestPoint
  nearest(const Vec3& p, double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Calls visit(Index triangle) -> bool for every triangle whose box meets the closed box, and
  /// perhaps for a few whose boxes miss it by rounding; stops when visit returns false.
  /// \returns false if it was stopped
  template <class Visit> bool visit_box(const Box3& box, const Visit& visit) const;

  /// The same for every triangle whose box meets the closed segment p q.
  template <class Visit> bool visit_segment(const Vec3& p, const Vec3& q, const Visit& visit) const;

  /// The first triangle that the ray from `origin` along `direction` meets, to rounding. Its
  /// distance is a multiple of the direction's length, up to max_distance.
  [[nodiscard]] RayHit
  first_hit(const Vec3& origin, const Vec3& direction,
            double max_distance = std::numeric_limits<double>::infinity()) const;

private:
  friend class BvhBuilder;
  friend MeshDistance mesh_distance(const TriangleBvh& a, const TriangleBvh& b,
                                    double max_distance);

  static constexpr Index leaf_bit = Index{1} << 31U;
  static constexpr int stack_size = 192; // three waiting siblings on each of at most 64 levels

  struct alignas(64) Node {
    float low[3][4]; // of the four children; an empty slot has low > high
    float high[3][4];
    Index child[4]; // a node, or a triangle with the leaf bit
  };
  struct Corners {
    Vec3 at[3];
  };
  /// A box in the hierarchy's own frame, rounded outward.
  struct FloatBox {
    float low[3];
    float high[3];
  };
  struct FloatSegment {
    float middle[3];
    float half[3]; // absolute values of half the vector p q
    float signed_half[3];
  };

  [[nodiscard]] FloatBox to_frame(const Vec3& low, const Vec3& high) const;
  [[nodiscard]] FloatSegment to_frame_segment(const Vec3& p, const Vec3& q) const;
  static unsigned overlap_mask(const Node& node, const FloatBox& box);
  static unsigned overlap_mask(const Node& node, const FloatSegment& segment);

  /// Offers the triangles of this mesh to `best`, with t, triangle `index` of another.
  void improve(MeshDistance& best, const Vec3 (&t)[3], Index index) const;

  template <class Query, class Visit>
  bool visit_nodes(const Query& query, const Visit& visit) const;

  // Boxes are those of (x - origin) * scale, so that they fill about [-1, 1]^3 whatever the mesh.
  Vec3 origin_ = Vec3::Zero();
  double scale_ = 1;
  std::vector<Node> nodes_; // the root first; none for no triangles
  std::vector<Corners> corners_;
};

/// Calls visit(Index i, Index j) for every two triangles i of a and j of b whose boxes overlap (and
/// perhaps a few more, by rounding), on one thread, in a fixed order.
template <class Visit>
void visit_overlapping(const TriangleBvh& a, const TriangleBvh& b, const Visit& visit);

/// Every two triangles i of a and j of b whose boxes overlap, in rising order of (i, j). Parallel.
std::vector<std::pair<Index, Index>> overlapping_pairs(const TriangleBvh& a, const TriangleBvh& b);

/// Every two triangles i < j of one mesh whose boxes overlap, in rising order of (i, j): those that
/// share a corner are among them. Parallel.
std::vector<std::pair<Index, Index>> overlapping_pairs(const TriangleBvh& mesh);

/// The least distance between two meshes, if it is below max_distance (otherwise no triangles, and
/// the distance is max_distance). Parallel; the same on any number of threads.
MeshDistance mesh_distance(const TriangleBvh& a, const TriangleBvh& b,
                           double max_distance = std::numeric_limits<double>::infinity());

// ---- What follows is implementation

inline unsigned TriangleBvh::overlap_mask(const Node& node, const FloatBox& box) {
  std::array<bool, 4> meets;
  for (int i = 0; i < 4; ++i) {
    meets[i] = (node.low[0][i] <= box.high[0]) & (node.high[0][i] >= box.low[0]) &
               (node.low[1][i] <= box.high[1]) & (node.high[1][i] >= box.low[1]) &
               (node.low[2][i] <= box.high[2]) & (node.high[2][i] >= box.low[2]);
  }
  return static_cast<unsigned>(meets[0]) | static_cast<unsigned>(meets[1]) << 1U |
         static_cast<unsigned>(meets[2]) << 2U | static_cast<unsigned>(meets[3]) << 3U;
}

template <class Query, class Visit>
bool TriangleBvh::visit_nodes(const Query& query, const Visit& visit) const {
  if (nodes_.empty()) {
    return true;
  }
  std::array<Index, stack_size> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    for (unsigned mask = overlap_mask(node, query); mask != 0; mask &= mask - 1) {
      const Index child = node.child[__builtin_ctz(mask)];
      if ((child & leaf_bit) == 0) {
        stack[top++] = child;
      } else if (!visit(child & ~leaf_bit)) {
        return false;
      }
    }
  }
  return true;
}

template <class Visit> bool TriangleBvh::visit_box(const Box3& box, const Visit& visit) const {
  return visit_nodes(to_frame(box.min(), box.max()), visit);
}

template <class Visit>
bool TriangleBvh::visit_segment(const Vec3& p, const Vec3& q, const Visit& visit) const {
  return visit_nodes(to_frame_segment(p, q), visit);
}

template <class Visit>
void visit_overlapping(const TriangleBvh& a, const TriangleBvh& b, const Visit& visit) {
  for (Index i = 0; i < a.triangle_count(); ++i) {
    const Vec3(&t)[3] = a.corners(i);
    Box3 box(t[0]);
    box.extend(t[1]);
    box.extend(t[2]);
    b.visit_box(box, [&](Index j) {
      visit(i, j);
      return true;
    });
  }
}

} // namespace cagewright
