#include "spatial/surface_tree.h"

#include "core/random.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace cagewright {
namespace {

Vec3 random_vector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

// Triangles of all sizes, some without area.
TriangleMesh soup(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (Index t = 0; t < 60; ++t) {
    const Vec3 at = random_vector(random);
    const double size = random.uniform(0, 0.4);
    for (int i = 0; i < 3; ++i) {
      mesh.positions.push_back(t % 9 == 0 ? at : Vec3(at + size * random_vector(random)));
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

Corners corners(const TriangleMesh& mesh, std::size_t f) {
  const Triangle& t = mesh.triangles[f];
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

TEST(SurfaceTree, FindsTheNearestPoint) {
  const TriangleMesh mesh = soup(1);
  const SurfaceTree tree(mesh);
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 p = 2 * random_vector(random);
    double least = 1e9;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Corners t = corners(mesh, f);
      least = std::min(least, point_triangle_distance(p, t[0], t[1], t[2]));
    }
    EXPECT_NEAR(tree.nearest(p).distance, least, 1e-12);
    EXPECT_LE(tree.nearest(p, 10, 0.05).distance, 1.05 * least + 1e-12);
    EXPECT_EQ(std::isfinite(tree.nearest(p, 0.2).distance), least < 0.2);
  }
}

TEST(SurfaceTree, HasEachTriangleHoweverManyThereAre) {
  Random random(5);
  for (const Index count : {1U, 7U, 8U, 9U, 12U, 15U, 16U, 17U, 63U, 64U, 65U, 100U, 513U, 700U}) {
    TriangleMesh mesh; // small triangles far apart
    for (Index t = 0; t < count; ++t) {
      const Vec3 at(3 * (t % 9), 3 * (t / 9 % 9), 3 * (t / 81));
      for (int i = 0; i < 3; ++i) {
        mesh.positions.push_back(at + random_vector(random));
      }
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const SurfaceTree tree(mesh);
    for (Index t = 0; t < count; ++t) {
      const Corners c = corners(mesh, t);
      const SurfaceTree::Nearest found = tree.nearest((c[0] + c[1] + c[2]) / 3);
      EXPECT_EQ(found.triangle, t) << count;
      EXPECT_NEAR(found.distance, 0, 1e-12) << count;
    }
  }
}

TEST(SurfaceNode, FindsTheLastOfTheLeastLanes) {
  Random random(6);
  for (int trial = 0; trial < 500; ++trial) {
    alignas(32) SurfaceNode::Lanes lanes;
    for (float& lane : lanes) { // of few values: some are equal
      const double x = std::floor(random.uniform(0, 5));
      lane = x == 4 ? std::numeric_limits<float>::infinity() : static_cast<float>(x);
    }
    int last = 0;
    for (int i = 1; i < SurfaceNode::width; ++i) {
      last = lanes[i] <= lanes[last] ? i : last;
    }
    for (const float most : {0.0F, 1.0F, 2.5F, 1e30F}) {
      EXPECT_EQ(least_below(lanes, most), lanes[last] < most ? last : -1);
    }
  }
}

TEST(SurfaceTree, KnowsWhatIsTooNear) {
  const TriangleMesh mesh = soup(3);
  const SurfaceTree tree(mesh);
  Random random(4);
  int near = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 at = 1.3 * random_vector(random);
    const Corners t = {at, at + 0.5 * random_vector(random), at + 0.5 * random_vector(random)};
    double least = 1e9;
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      least = std::min(least, triangle_triangle_distance(t.at, corners(mesh, f).at));
    }
    EXPECT_EQ(tree.too_near(t, 0.1).has_value(), least < 0.1);
    const auto pair = tree.nearest_to(t, 0.2);
    EXPECT_EQ(pair.has_value(), least < 0.2);
    if (pair) {
      EXPECT_NEAR(pair->distance, least, 1e-12);
      ++near;
    }
  }
  EXPECT_GT(near, 30);
  EXPECT_LT(near, 270);
}

// Each is attained, since it lies on the model, and no sample of its column is higher.
TEST(SurfaceTree, FindsTheHighestPointOfEachColumnOfATriangle) {
  const TriangleMesh mesh = soup(7);
  const SurfaceTree tree(mesh);
  Random random(8);
  constexpr double least = -0.2;
  constexpr double most = 10;
  std::size_t found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Corners t = {random_vector(random), random_vector(random), random_vector(random)};
    const int cells = 1 + trial % SurfaceTree::most_cells;
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const auto column = [&](double b, double c) { // and whether the column is of a cell
      const std::array<int, 3> key = {static_cast<int>(std::floor(b * cells)),
                                      static_cast<int>(std::floor(c * cells)),
                                      static_cast<int>(std::floor((1 - b - c) * cells))};
      return std::pair(key, b >= 0 && c >= 0 && b + c <= 1);
    };
    std::map<std::array<int, 3>, double> highest;
    for (const SurfaceTree::Relief& top : tree.relief(t, cells, least, most)) {
      const Vec3 p = t[0] + top.at_b * (t[1] - t[0]) + top.at_c * (t[2] - t[0]) + top.height * n;
      EXPECT_LT(tree.nearest(p).distance, 1e-12);
      EXPECT_GT(top.height, least);
      ++found;
      // Between two columns it counts for both.
      for (const double aside_b : {-3e-9, -1e-9, 1e-9, 3e-9}) {
        for (const double aside_c : {-3e-9, -1e-9, 1e-9, 3e-9}) {
          double& height =
              highest.try_emplace(column(top.at_b + aside_b, top.at_c + aside_c).first, least)
                  .first->second;
          height = std::max(height, top.height);
        }
      }
    }
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Corners m = corners(mesh, f);
      constexpr int samples = 12;
      for (int i = 0; i <= samples; ++i) {
        for (int j = 0; i + j <= samples; ++j) {
          const Vec3 p = (i * m[0] + j * m[1] + (samples - i - j) * m[2]) / samples - t[0];
          const Vec3 ab = t[1] - t[0];
          const Vec3 ac = t[2] - t[0];
          const double height = n.dot(p);
          const double b = p.cross(ac).dot(n) / ab.cross(ac).dot(n);
          const double c = ab.cross(p).dot(n) / ab.cross(ac).dot(n);
          const auto [key, inside] = column(b, c);
          if (inside && height > least + 1e-9) {
            ASSERT_TRUE(highest.contains(key));
            EXPECT_LE(height, highest[key] + 1e-9);
          }
        }
      }
    }
  }
  EXPECT_GT(found, 60U);
}

TEST(SurfaceTree, FindsTheHighestPointBetweenThreeSides) {
  const TriangleMesh mesh = make_icosphere(2);
  const SurfaceTree tree(mesh);
  Random random(6);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 n = random_vector(random).normalized();
    const HalfSpace plane{n, random.uniform(-1, 1)};
    std::array<HalfSpace, 3> sides;
    for (HalfSpace& s : sides) {
      s = {random_vector(random).normalized(), random.uniform(-0.2, 0.7)};
    }
    const auto top = tree.highest(plane, sides, -0.3, 0.2);
    double sampled = -0.3;
    for (int sample = 0; sample < 2000; ++sample) {
      const Corners t = corners(mesh, random.below(mesh.triangles.size()));
      const double a = random.uniform();
      const double b = random.uniform(0, 1 - a);
      const Vec3 p = t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
      const bool inside = std::all_of(sides.begin(), sides.end(),
                                      [&](const HalfSpace& s) { return s.above(p) <= 0; });
      if (inside && plane.above(p) <= 0.2) {
        sampled = std::max(sampled, plane.above(p));
      }
    }
    if (top) {
      EXPECT_GE(top->height, sampled - 1e-12);
      EXPECT_NEAR(plane.above(top->point), top->height, 1e-12);
      for (const HalfSpace& s : sides) {
        EXPECT_LE(s.above(top->point), 1e-12);
      }
      EXPECT_LT(tree.nearest(top->point).distance, 1e-12);
    } else {
      EXPECT_EQ(sampled, -0.3);
    }
  }
}

TEST(SurfaceTree, OfNothingFindsNothing) {
  const SurfaceTree tree{TriangleView()};
  EXPECT_FALSE(std::isfinite(tree.nearest(Vec3::Zero()).distance));
  EXPECT_FALSE(tree.too_near({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}, 1));
}

} // namespace
} // namespace cagewright
