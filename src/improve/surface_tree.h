/// \file
/// The model as the improvement asks for it: how near, how clear, how high.
#pragma once

#include "improve/closest.h"
#include "mesh/triangle_mesh.h"

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace cagewright {

/// A half space: the points x with normal . x <= offset.
struct HalfSpace {
  Vec3 normal;
  double offset = 0;

  [[nodiscard]] double above(const Vec3& x) const { return normal.dot(x) - offset; }
};

/// A hierarchy of boxes over a model's triangles. It owns a copy of the corners, in its own order.
class SurfaceTree {
public:
  /// Cost: O(T log T); a tenth of a second for 100,000 triangles.
  explicit SurfaceTree(TriangleView model);

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 point = Vec3::Zero();
  };

  /// The point of the model nearest to p, if one is nearer than `within`; else the distance is
  /// infinite. With an `error` the distance may be too large by this share, which is much quicker
  /// far from the model.
  [[nodiscard]] Nearest nearest(const Vec3& p,
                                double within = std::numeric_limits<double>::infinity(),
                                double error = 0) const;

  /// A pair of points of the triangle (first) and of the model (second) nearer than `distance`,
  /// if there is one: any, not the nearest. None: the triangle keeps this distance everywhere.
  [[nodiscard]] std::optional<NearestPair> too_near(const Corners& triangle, double distance) const;

  /// The same, but the nearest pair of all.
  [[nodiscard]] std::optional<NearestPair> nearest_to(const Corners& triangle, double within) const;

  struct Highest {
    double height = 0;
    Vec3 point = Vec3::Zero();
  };

  /// The point of the model with the greatest height above `plane`, among those inside all three
  /// `sides` and with heights between `least` and `most`. None: there is none.
  [[nodiscard]] std::optional<Highest> highest(const HalfSpace& plane,
                                               const std::array<HalfSpace, 3>& sides, double least,
                                               double most) const;

private:
  struct Node {
    Vec3 center;
    Vec3 half;
    Index first = 0; ///< of the triangles of a leaf, or the first of two children
    Index count = 0; ///< triangles of a leaf; 0: an inner node
  };

  void build(std::span<const Corners> corners);

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

} // namespace cagewright
