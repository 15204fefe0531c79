/// \file
/// The model as the improvement asks for it: how near, how clear, how high.
#pragma once

#include "spatial/distance.h"
#include "spatial/surface_node.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace cagewright {

/// The corners of a triangle, by value.
struct Corners {
  Vec3 at[3];

  const Vec3& operator[](std::size_t i) const { return at[i]; }
  [[nodiscard]] const Vec3* begin() const { return at; }
  [[nodiscard]] const Vec3* end() const { return at + 3; }
};

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
    Index triangle = ~Index{0}; ///< of the model
  };

  /// The point of the model nearest to p, if one is nearer than `within`; else the distance is
  /// infinite. With an `error` the distance may be too large by this share, which is much quicker
  /// far from the model.
  [[nodiscard]] Nearest nearest(const Vec3& p,
                                double within = std::numeric_limits<double>::infinity(),
                                double error = 0) const;

  /// A pair of points of the triangle (a) and of the model (b) nearer than `distance`,
  /// if there is one: any, not the nearest. None: the triangle keeps this distance everywhere.
  [[nodiscard]] std::optional<ClosestPoints> too_near(const Corners& triangle,
                                                      double distance) const;

  /// The same, but the nearest pair of all.
  [[nodiscard]] std::optional<ClosestPoints> nearest_to(const Corners& triangle,
                                                        double within) const;

  struct Highest {
    double height = 0;
    Vec3 point = Vec3::Zero();
  };

  /// The point of the model with the greatest height above `plane`, among those inside all three
  /// `sides` and with heights between `least` and `most`. None: there is none. With an `error` its
  /// height above `least` may be too small by this share.
  [[nodiscard]] std::optional<Highest> highest(const HalfSpace& plane,
                                               const std::array<HalfSpace, 3>& sides, double least,
                                               double most, double error = 0) const;

  /// A point of the model above or below a triangle (a, b, c): its foot is
  /// (1 - at_b - at_c) a + at_b b + at_c c.
  struct Relief {
    double at_b = 0;
    double at_c = 0;
    double height = 0;
  };

  static constexpr int most_cells = 4;

  /// The model's relief over a triangle: of the cells^2 similar triangles that it is cut into, the
  /// highest point of the model in the column of each, among heights between `least` and `most`.
  /// Columns without one are left out. The triangle must have an area.
  [[nodiscard]] std::vector<Relief> relief(const Corners& triangle, int cells, double least,
                                           double most) const;

private:
  static constexpr Index leaf_bit = Index{1} << 31U;
  static constexpr int width = SurfaceNode::width;

  void build(std::span<const Corners> corners);
  void set_slot(SurfaceNode& node, int slot, std::span<const Index> range,
                std::span<const Corners> corners) const;
  void to_frame(const Vec3& p, float (&result)[3]) const;
  [[nodiscard]] float length_in_frame(double length) const {
    return static_cast<float>(length * scale_);
  }
  void prefetch(Index child) const; ///< of a node, or of a triangle
  template <class Visit> void visit_near(const Corners& triangle, double within, Visit visit) const;

  Vec3 origin_ = Vec3::Zero();
  double scale_ = 1; // the frame is (x - origin) * scale: the model fills about [-1, 1]^3
  std::vector<Corners> triangles_;
  std::vector<Index> numbers_; // of the triangles in the model
  std::vector<SurfaceNode> nodes_;
};

} // namespace cagewright
