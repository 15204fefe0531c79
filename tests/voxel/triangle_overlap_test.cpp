#include "voxel/triangle_overlap.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

namespace cagewright {
namespace {

// Just enough of the rational numbers to clip a small triangle exactly.
class Fraction {
public:
  Fraction(__int128 n = 0, __int128 d = 1) : n_(n), d_(d) { // NOLINT: whole numbers are fractions
    if (d_ < 0) {
      n_ = -n_;
      d_ = -d_;
    }
    __int128 a = n_ < 0 ? -n_ : n_;
    __int128 b = d_;
    while (b != 0) {
      a %= b;
      std::swap(a, b);
    }
    n_ /= a;
    d_ /= a;
  }
  friend Fraction operator+(Fraction a, Fraction b) {
    return {a.n_ * b.d_ + b.n_ * a.d_, a.d_ * b.d_};
  }
  friend Fraction operator-(Fraction a, Fraction b) {
    return {a.n_ * b.d_ - b.n_ * a.d_, a.d_ * b.d_};
  }
  friend Fraction operator*(Fraction a, Fraction b) { return {a.n_ * b.n_, a.d_ * b.d_}; }
  friend Fraction operator/(Fraction a, Fraction b) { return {a.n_ * b.d_, a.d_ * b.n_}; }
  [[nodiscard]] int sign() const { return n_ > 0 ? 1 : n_ < 0 ? -1 : 0; }

private:
  __int128 n_;
  __int128 d_;
};

using Point = std::array<Fraction, 3>;
using Cell = std::array<int, 3>;

// The part of a convex polygon where factor * (coordinate - bound) >= 0.
std::vector<Point> clipped(const std::vector<Point>& polygon, int axis, int bound, int factor) {
  const auto height = [&](const Point& p) {
    return Fraction(factor) * (p[axis] - Fraction(bound));
  };
  std::vector<Point> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const Fraction ha = height(a);
    const Fraction hb = height(b);
    if (ha.sign() >= 0) {
      result.push_back(a);
    }
    if (ha.sign() * hb.sign() < 0) {
      const Fraction t = ha / (ha - hb);
      Point cut;
      for (int k = 0; k < 3; ++k) {
        cut[k] = a[k] + t * (b[k] - a[k]);
      }
      result.push_back(cut);
    }
  }
  return result;
}

bool touches_exactly(std::vector<Point> triangle, const Cell& cell) {
  for (int axis = 0; axis < 3; ++axis) {
    triangle = clipped(triangle, axis, cell[axis], 1);
    triangle = clipped(triangle, axis, cell[axis] + 1, -1);
  }
  return !triangle.empty();
}

constexpr int cells = 5; // along an edge of the cube that the triangles lie in
constexpr int parts = 4; // of a cell: the corners of triangles are multiples of 1 / parts

using Corners = std::array<Cell, 3>; // in parts

std::set<Cell> found(const Corners& t) {
  std::array<Vec3, 3> p;
  for (int i = 0; i < 3; ++i) {
    p[i] = Vec3(t[i][0], t[i][1], t[i][2]) / parts;
  }
  std::set<Cell> result;
  TriangleOverlap(p[0], p[1], p[2], 1e-9).for_each_cell([&](const Cell& cell) {
    EXPECT_TRUE(result.insert(cell).second) << "visited twice";
  });
  return result;
}

std::set<Cell> expected(const Corners& t) {
  std::vector<Point> triangle;
  for (const Cell& c : t) {
    triangle.push_back({Fraction(c[0], parts), Fraction(c[1], parts), Fraction(c[2], parts)});
  }
  std::set<Cell> result;
  for (int z = -1; z <= cells; ++z) {
    for (int y = -1; y <= cells; ++y) {
      for (int x = -1; x <= cells; ++x) {
        if (touches_exactly(triangle, {x, y, z})) {
          result.insert({x, y, z});
        }
      }
    }
  }
  return result;
}

Cell random_corner(Random& random, int low, int high) {
  Cell c;
  for (int& x : c) {
    x = low + static_cast<int>(random.below(static_cast<std::uint64_t>(high - low + 1)));
  }
  return c;
}

TEST(TriangleOverlap, FindsExactlyTheClosedCellsThatATriangleTouches) {
  Random random(1);
  for (int i = 0; i < 400; ++i) {
    const Corners t = {random_corner(random, 0, cells * parts),
                       random_corner(random, 0, cells * parts),
                       random_corner(random, 0, cells * parts)};
    ASSERT_EQ(found(t), expected(t)) << "triangle " << i;
  }
}

TEST(TriangleOverlap, FindsExactlyTheCellsOfSmallTriangles) {
  Random random(2);
  for (int i = 0; i < 400; ++i) {
    const Corners t = {random_corner(random, 4, 9), random_corner(random, 4, 9),
                       random_corner(random, 4, 9)};
    ASSERT_EQ(found(t), expected(t)) << "triangle " << i;
  }
}

TEST(TriangleOverlap, FindsExactlyTheCellsOfSegmentsAndPoints) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Cell a = random_corner(random, 0, cells * parts);
    const Cell b = i % 4 == 0 ? a : random_corner(random, 0, cells * parts);
    const Corners t = i % 2 == 0 ? Corners{a, b, b} : Corners{a, b, a};
    ASSERT_EQ(found(t), expected(t)) << "segment " << i;
  }
}

TEST(TriangleOverlap, ReachesFurtherWhenCellsGrow) {
  const TriangleOverlap point({2.4, 2.5, 2.5}, {2.4, 2.5, 2.5}, {2.4, 2.5, 2.5}, 0.45);
  std::set<Cell> reached;
  point.for_each_cell([&](const Cell& cell) { reached.insert(cell); });
  EXPECT_EQ(reached, (std::set<Cell>{{1, 2, 2}, {2, 2, 2}}));
}

} // namespace
} // namespace cagewright
