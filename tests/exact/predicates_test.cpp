#include "exact/predicates.h"

#include "core/random.h"
#include "mesh/shapes.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace cagewright {
namespace {

using Rational = boost::multiprecision::cpp_rational;

int rational_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto u = [&](const Vec3& p, int k) { return Rational(Rational(p[k]) - Rational(a[k])); };
  const Rational det = u(b, 0) * (u(c, 1) * u(d, 2) - u(c, 2) * u(d, 1)) -
                       u(b, 1) * (u(c, 0) * u(d, 2) - u(c, 2) * u(d, 0)) +
                       u(b, 2) * (u(c, 0) * u(d, 1) - u(c, 1) * u(d, 0));
  return det.sign();
}

int rational_orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  const Rational det = (Rational(b[u]) - Rational(a[u])) * (Rational(c[v]) - Rational(a[v])) -
                       (Rational(b[v]) - Rational(a[v])) * (Rational(c[u]) - Rational(a[u]));
  return det.sign();
}

Vec3 random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(Orient3d, IsPositiveOnTheSideOfTheNormal) {
  const Vec3 a(0, 0, 0);
  const Vec3 b(1, 0, 0);
  const Vec3 c(0, 1, 0);
  EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, 1e-300}), 1);
  EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, -1e-300}), -1);
  EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, 0}), 0);
}

TEST(Orient3d, AgreesWithRationalsWherePointsAreAllButCoplanar) {
  Random random(1);
  int coplanar = 0;
  for (int i = 0; i < 8000; ++i) {
    const double size = std::pow(10, random.uniform(-9, 9));
    const Vec3 shift =
        random_point(random, i % 3 == 0 ? 0 : size * std::pow(10, random.uniform(0, 6)));
    std::array<Vec3, 3> p;
    for (Vec3& x : p) {
      x = random_point(random, size) + shift;
      if (i % 4 == 0) { // on a lattice: often exactly coplanar
        x = (x / size).array().round() * size;
      }
    }
    const Vec3 d = p[0] + random.uniform() * (p[1] - p[0]) + random.uniform() * (p[2] - p[0]);
    const int expected = rational_orient3d(p[0], p[1], p[2], d);
    coplanar += expected == 0 ? 1 : 0;
    ASSERT_EQ(orient3d(p[0], p[1], p[2], d), expected);
    ASSERT_EQ(orient3d(p[1], p[0], p[2], d), -expected);
    ASSERT_EQ(orient3d(d, p[0], p[1], p[2]), -expected);
  }
  EXPECT_GT(coplanar, 50);
}

TEST(Orient3d, AgreesWithRationalsAtTheEndsOfTheRange) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    std::array<Vec3, 4> p;
    for (Vec3& x : p) {
      for (double& coordinate : x) {
        coordinate = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.below(1300)) - 1000);
      }
    }
    p[3] = p[0] + 0.25 * (p[1] - p[0]) + 0.5 * (p[2] - p[0]);
    ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), rational_orient3d(p[0], p[1], p[2], p[3]));
  }
}

TEST(Orient2d, AgreesWithRationals) {
  Random random(3);
  for (int i = 0; i < 8000; ++i) {
    const double size = std::pow(10, random.uniform(-9, 9));
    const Vec3 shift = random_point(random, size * std::pow(10, random.uniform(-2, 6)));
    const Vec3 a = random_point(random, size) + shift;
    const Vec3 b = random_point(random, size) + shift;
    const Vec3 c = a + random.uniform() * (b - a);
    ASSERT_EQ(orient2d(a, b, c, 0), rational_orient2d(a, b, c, 1, 2));
    ASSERT_EQ(orient2d(a, b, c, 1), rational_orient2d(a, b, c, 2, 0));
    ASSERT_EQ(orient2d(a, b, c, 2), rational_orient2d(a, b, c, 0, 1));
  }
}

TEST(IsDegenerate, TellsAHairsBreadthFromNothing) {
  const Vec3 a(0.1, 0.2, 0.3);
  const Vec3 b(0.2, 0.4, 0.6);
  EXPECT_TRUE(is_degenerate(a, b, 2 * a));
  EXPECT_TRUE(is_degenerate(a, a, b));
  EXPECT_TRUE(is_degenerate(a, a, a));
  // 0.1 + 0.2 is not 0.3 in doubles: the point is off the line by its last bit.
  EXPECT_FALSE(is_degenerate(a, b, {0.1 + 0.2, 2 * 0.3, 3 * 0.3}));
}

// ---- Triangles on a small lattice, where every degeneracy turns up, against integers

using Lattice = std::array<long, 3>;
using LatticeTriangle = std::array<Lattice, 3>;

Lattice minus(const Lattice& a, const Lattice& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Lattice cross(const Lattice& a, const Lattice& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long dot(const Lattice& a, const Lattice& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool separates(const Lattice& axis, const LatticeTriangle& a, const LatticeTriangle& b) {
  const auto [a_low, a_high] = std::minmax({dot(axis, a[0]), dot(axis, a[1]), dot(axis, a[2])});
  const auto [b_low, b_high] = std::minmax({dot(axis, b[0]), dot(axis, b[1]), dot(axis, b[2])});
  return a_high < b_low || b_high < a_low;
}

/// Two disjoint triangles are separated along the direction between their nearest points: between
/// two corners, from a corner square to an edge, square to two edges, or along a normal.
bool lattice_intersect(const LatticeTriangle& a, const LatticeTriangle& b) {
  std::vector<Lattice> edges;
  for (int i = 0; i < 3; ++i) {
    edges.push_back(minus(a[(i + 1) % 3], a[i]));
    edges.push_back(minus(b[(i + 1) % 3], b[i]));
  }
  for (const Lattice& e : edges) {
    for (const Lattice& f : edges) {
      if (separates(cross(e, f), a, b)) {
        return false;
      }
    }
  }
  for (const Lattice& p : a) {
    for (const Lattice& q : b) {
      const Lattice d = minus(p, q);
      if (separates(d, a, b)) {
        return false;
      }
      for (const Lattice& e : edges) {
        if (separates(cross(e, cross(d, e)), a, b)) {
          return false;
        }
      }
    }
  }
  return true;
}

TEST(TrianglesIntersect, AgreesWithIntegersInEveryDegeneracy) {
  Random random(4);
  int meeting = 0;
  for (int i = 0; i < 20000; ++i) {
    // Exact in doubles whatever the unit and the shift: powers of two, or sums of few bits.
    const double unit = std::ldexp(1, static_cast<int>(random.below(80)) - 40);
    const double shift = unit * static_cast<double>(random.below(1U << 20U)) * (i % 2);
    const long reach = 1 + static_cast<long>(random.below(4));
    std::array<LatticeTriangle, 2> lattice;
    Vec3 t[2][3];
    for (int k = 0; k < 6; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const long x = static_cast<long>(random.below(static_cast<std::uint64_t>(reach) + 1));
        lattice[k / 3][k % 3][axis] = x;
        t[k / 3][k % 3][axis] = static_cast<double>(x) * unit + shift;
      }
    }
    const bool expected = lattice_intersect(lattice[0], lattice[1]);
    meeting += expected ? 1 : 0;
    ASSERT_EQ(triangles_intersect(t[0], t[1]), expected);
    ASSERT_EQ(triangles_intersect(t[1], t[0]), expected);
    // A triangle with a corner twice is a segment.
    lattice[0][2] = lattice[0][1];
    ASSERT_EQ(segment_intersects_triangle(t[0][0], t[0][1], t[1][0], t[1][1], t[1][2]),
              lattice_intersect(lattice[0], lattice[1]));
    lattice[1][2] = lattice[1][1];
    ASSERT_EQ(segments_intersect(t[0][0], t[0][1], t[1][0], t[1][1]),
              lattice_intersect(lattice[0], lattice[1]));
  }
  EXPECT_GT(meeting, 2000);
  EXPECT_LT(meeting, 18000);
}

TEST(TrianglesIntersect, TellsTouchingFromAHairsBreadth) {
  const Vec3 floor[3] = {{0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}};
  const Vec3 touching[3] = {{0.2, 0.2, 0.1}, {0.3, 0.1, 1}, {0.1, 0.4, 1}};
  const Vec3 above[3] = {{0.2, 0.2, std::nextafter(0.1, 1)}, {0.3, 0.1, 1}, {0.1, 0.4, 1}};
  EXPECT_TRUE(triangles_intersect(floor, touching));
  EXPECT_FALSE(triangles_intersect(floor, above));
}

// ---- Faces of one mesh

TEST(FacesCross, AcceptsTheNeighborsInASphere) {
  const TriangleMesh sphere = make_icosphere(1);
  for (std::size_t i = 0; i < sphere.triangles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      ASSERT_FALSE(faces_cross(sphere.positions, sphere.triangles[i], sphere.triangles[j]));
    }
  }
}

TEST(FacesCross, FindsAFoldOverASharedEdge) {
  std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.6, 2, 0}, {0.6, -2, 0}};
  EXPECT_TRUE(faces_cross(x, {0, 1, 2}, {1, 0, 3}));
  EXPECT_FALSE(faces_cross(x, {0, 1, 2}, {1, 0, 4}));
  x[3].z() = 1e-300;
  EXPECT_FALSE(faces_cross(x, {0, 1, 2}, {1, 0, 3}));
}

TEST(FacesCross, FindsWhatPassesThroughBesideASharedCorner) {
  const std::vector<Vec3> x = {{0, 0, 0},  {2, -1, 0},  {2, 1, 0}, {2, 0, 1}, {2, 0, -1},
                               {-2, 0, 1}, {-2, 0, -1}, {1, 0, 0}, {-1, 0, 5}};
  EXPECT_TRUE(faces_cross(x, {0, 1, 2}, {0, 3, 4}));
  EXPECT_FALSE(faces_cross(x, {0, 1, 2}, {0, 5, 6}));
  EXPECT_TRUE(faces_cross(x, {0, 1, 2}, {0, 7, 8})); // an edge lies in the other face
}

// What two triangles have in common is convex, and holds the corner they share. If it holds more it
// reaches the side opposite to it of one of them: the corner cut off, they still meet. Without the
// corner they are triangles like others.
TEST(FacesCross, BesideASharedCornerAgreesWithTrianglesThatLackIt) {
  Random random(3);
  const auto point = [&] {
    return Vec3(static_cast<double>(random.below(5)) - 2, static_cast<double>(random.below(5)) - 2,
                static_cast<double>(random.below(5)) - 2);
  };
  int crossing = 0;
  int touching_at_the_corner = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const std::vector<Vec3> x = {Vec3::Zero(), point(), point(), point(), point()};
    if (is_degenerate(x[0], x[1], x[2]) || is_degenerate(x[0], x[3], x[4])) {
      continue;
    }
    constexpr double cut = 1.0 / 1024; // nearer to the corner than grid lines can meet a side
    bool expected = false;
    for (const int s : {0, 1}) {
      for (const int t : {0, 1}) {
        const Vec3 a[3] = {x[1] * (s == 0 ? 1 : cut), x[2], s == 0 ? x[1] * cut : x[2] * cut};
        const Vec3 b[3] = {x[3] * (t == 0 ? 1 : cut), x[4], t == 0 ? x[3] * cut : x[4] * cut};
        expected = expected || triangles_intersect(a, b);
      }
    }
    ASSERT_EQ(faces_cross(x, {0, 1, 2}, {0, 3, 4}), expected) << "trial " << trial;
    ASSERT_EQ(faces_cross(x, {2, 0, 1}, {3, 4, 0}), expected) << "trial " << trial;
    ++(expected ? crossing : touching_at_the_corner);
  }
  EXPECT_GT(crossing, 1000);
  EXPECT_GT(touching_at_the_corner, 1000);
}

TEST(FacesCross, CountsARepeatedFace) {
  const TriangleMesh cube = make_cube();
  const Triangle t = cube.triangles[0];
  EXPECT_TRUE(faces_cross(cube.positions, t, {t[1], t[0], t[2]}));
}

// ---- Volume

TEST(VolumeSign, IsThatOfTheOrientation) {
  TriangleMesh sphere = make_icosphere(2);
  EXPECT_EQ(volume_sign(sphere), 1);
  for (Triangle& t : sphere.triangles) {
    std::swap(t[0], t[1]);
  }
  EXPECT_EQ(volume_sign(sphere), -1);
  EXPECT_EQ(volume_sign(TriangleMesh()), 0);
}

TEST(VolumeSign, IsExactForAFlakeFarFromTheOrigin) {
  TriangleMesh flake = make_tetrahedron();
  flake.positions = {{1e9, 0.1, 0.3}, {1e9 + 1, 0.1, 0.3}, {1e9, 1.1, 0.3}, {1e9, 0.1, 0.3}};
  flake.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_EQ(volume_sign(flake), 0);
  flake.positions[3].z() = std::nextafter(0.3, 1);
  EXPECT_EQ(volume_sign(flake), 1);
  flake.positions[3].z() = std::nextafter(0.3, 0);
  EXPECT_EQ(volume_sign(flake), -1);
}

} // namespace
} // namespace cagewright
