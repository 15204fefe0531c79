/// \file
/// Which cells of a grid a triangle touches.
#pragma once

#include <cagewright/core/geometry.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cagewright {

/// A triangle, given in grid coordinates, ready to be tested against the unit cells of the grid,
/// each grown by `grow` > 0 on every side. Triangles without area, segments and points, are
/// welcome.
///
/// Two convex bodies are apart when their projections on some axis are; for a triangle and a box
/// the 13 axes tried here decide (Akenine-Moeller 2001): the box's 3, the triangle's normal, and
/// the 9 products of an edge and one of the box's axes. On each the interval of the triangle comes
/// from all three corners: so even where round-off falsifies the direction of an axis, which it
/// does for needles, the axis separates only what is apart, give or take round-off, and `grow` is
/// far above that. The test errs only towards touching.
class TriangleOverlap {
public:
  TriangleOverlap(const Vec3& a, const Vec3& b, const Vec3& c, double grow) : grow_(grow) {
    const std::array<Vec3, 3> corners = {a, b, c};
    low_ = a.cwiseMin(b).cwiseMin(c);
    high_ = a.cwiseMax(b).cwiseMax(c);
    normal_ = Axis((b - a).cross(c - a), corners, grow);
    for (int i = 0; i < 3; ++i) {
      const Vec3 edge = corners[(i + 1) % 3] - corners[i];
      for (int j = 0; j < 3; ++j) {
        products_[3 * j + i] = Axis(Vec3::Unit(j).cross(edge), corners, grow);
      }
    }
  }

  /// The cells that the triangle's own axis-aligned box touches.
  [[nodiscard]] std::array<int, 3> first() const {
    return {first_in(low_[0]), first_in(low_[1]), first_in(low_[2])};
  }
  [[nodiscard]] std::array<int, 3> last() const {
    return {last_in(high_[0]), last_in(high_[1]), last_in(high_[2])};
  }

  /// Whether the triangle touches the cell, which is one of those from first() to last().
  [[nodiscard]] bool touches(const std::array<int, 3>& cell) const {
    const Vec3 center(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
    return !normal_.separates(center) &&
           std::none_of(products_.begin(), products_.end(),
                        [&](const Axis& axis) { return axis.separates(center); });
  }

  /// Calls visit(cell) for every cell that the triangle touches, in a fixed order. Along columns in
  /// the direction nearest to the normal only the cells near the triangle's plane are tested.
  template <class Visit> void for_each_cell(const Visit& visit) const;

private:
  // A direction, and the interval along it in which the center of a touching cell must lie.
  struct Axis {
    Vec3 direction = Vec3::Zero();
    double low = 0;
    double high = 0;

    Axis() = default;
    Axis(const Vec3& d, const std::array<Vec3, 3>& corners, double grow) : direction(d) {
      const Vec3 at(d.dot(corners[0]), d.dot(corners[1]), d.dot(corners[2]));
      const double radius = (0.5 + grow) * d.cwiseAbs().sum();
      low = at.minCoeff() - radius;
      high = at.maxCoeff() + radius;
    }
    [[nodiscard]] bool separates(const Vec3& center) const {
      const double at = direction.dot(center);
      return at < low || at > high;
    }
  };

  [[nodiscard]] int first_in(double low) const {
    return static_cast<int>(std::ceil(low - grow_)) - 1;
  }
  [[nodiscard]] int last_in(double high) const {
    return static_cast<int>(std::floor(high + grow_));
  }

  double grow_;
  Vec3 low_;
  Vec3 high_;
  Axis normal_;
  std::array<Axis, 9> products_;
};

template <class Visit> void TriangleOverlap::for_each_cell(const Visit& visit) const {
  const std::array<int, 3> from = first();
  const std::array<int, 3> to = last();
  int w = 0;
  normal_.direction.cwiseAbs().maxCoeff(&w);
  const int u = (w + 1) % 3;
  const int v = (w + 2) % 3;
  const Vec3& n = normal_.direction;
  std::array<int, 3> cell{};
  for (cell[v] = from[v]; cell[v] <= to[v]; ++cell[v]) {
    for (cell[u] = from[u]; cell[u] <= to[u]; ++cell[u]) {
      int begin = from[w];
      int end = to[w];
      if (n[w] != 0) {
        // The centers at heights h with low <= n . (.., h) <= high; one cell more for round-off.
        const double rest = n[u] * (cell[u] + 0.5) + n[v] * (cell[v] + 0.5);
        const double h0 = (normal_.low - rest) / n[w];
        const double h1 = (normal_.high - rest) / n[w];
        begin = static_cast<int>(std::max<double>(begin, std::ceil(std::min(h0, h1) - 0.5) - 1));
        end = static_cast<int>(std::min<double>(end, std::floor(std::max(h0, h1) - 0.5) + 1));
      }
      for (cell[w] = begin; cell[w] <= end; ++cell[w]) {
        if (touches(cell)) {
          visit(cell);
        }
      }
    }
  }
}

} // namespace cagewright
