#include "spatial/bvh.h"

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace cagewright {
namespace {

Vec3 random_point(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// Triangles of all sizes thrown about, some degenerate, some stacked.
TriangleMesh soup(Index count) {
  Random random(count);
  TriangleMesh mesh;
  for (Index i = 0; i < count; ++i) {
    const Vec3 place = i % 7 == 0 ? Vec3(0.25, 0.5, -0.25) : random_point(random);
    const double size = std::pow(10, random.uniform(-4, -0.5));
    for (int k = 0; k < 3; ++k) {
      mesh.positions.emplace_back(place + (i % 11 == 0 ? 0 : size) * random_point(random));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, double factor, const Vec3& shift) {
  for (Vec3& p : mesh.positions) {
    p = p * factor + shift;
  }
  return mesh;
}

Box3 box_of(TriangleView mesh, Index t) {
  Box3 box;
  for (const Index v : mesh.triangles[t]) {
    box.extend(mesh.positions[v]);
  }
  return box;
}

double nearest_by_force(TriangleView mesh, const Vec3& p) {
  double least = HUGE_VAL;
  for (const Triangle& t : mesh.triangles) {
    least = std::min(least, point_triangle_distance(p, mesh.positions[t[0]], mesh.positions[t[1]],
                                                    mesh.positions[t[2]]));
  }
  return least;
}

struct Placed {
  const char* name;
  double scale;
  Vec3 shift;
};

void PrintTo(const Placed& placed, std::ostream* out) {
  *out << placed.name;
}

class BvhAnywhere : public testing::TestWithParam<Placed> {};

TEST_P(BvhAnywhere, FindsTheNearestPoint) {
  const auto& [name, scale, shift] = GetParam();
  Random random(1);
  for (const TriangleMesh& shape : {soup(1), soup(5), soup(700), make_torus(0.3, 40, 20)}) {
    const TriangleMesh mesh = moved(shape, scale, shift);
    const TriangleBvh bvh(mesh);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = random_point(random) * scale * (i % 10 == 0 ? 100 : 1.2) + shift;
      const NearestPoint nearest = bvh.nearest(p);
      const double expected = nearest_by_force(mesh, p);
      ASSERT_TRUE(nearest);
      ASSERT_EQ(nearest.distance, expected);
      ASSERT_EQ((p - nearest.point).norm(), expected);
      ASSERT_FALSE(bvh.nearest(p, expected * 0.999));
      ASSERT_TRUE(bvh.nearest(p, expected * 1.001));
    }
  }
}

TEST_P(BvhAnywhere, VisitsAllThatOverlapABox) {
  const auto& [name, scale, shift] = GetParam();
  const TriangleMesh mesh = moved(soup(900), scale, shift);
  const TriangleBvh bvh(mesh);
  Random random(2);
  for (int i = 0; i < 60; ++i) {
    Box3 box(random_point(random) * scale + shift);
    box.extend(box.min() + (random_point(random) * 0.3 * scale).cwiseAbs());
    std::set<Index> visited;
    bvh.visit_box(box, [&](Index t) {
      EXPECT_TRUE(visited.insert(t).second) << "visited twice";
      return true;
    });
    std::size_t overlapping = 0;
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      if (box_of(mesh, t).intersects(box)) {
        ++overlapping;
        ASSERT_TRUE(visited.contains(t));
      }
    }
    EXPECT_LE(visited.size(), overlapping + 3);
  }
}

TEST_P(BvhAnywhere, VisitsAllThatASegmentMeets) {
  const auto& [name, scale, shift] = GetParam();
  const TriangleMesh mesh = moved(soup(900), scale, shift);
  const TriangleBvh bvh(mesh);
  Random random(3);
  std::size_t met = 0;
  for (int i = 0; i < 200; ++i) {
    // Through a point of a triangle, far beyond it; often along an axis.
    const auto t = static_cast<Index>(random.below(mesh.triangles.size()));
    const Vec3 middle = box_of(mesh, t).center();
    const Vec3 direction = i % 2 == 0 ? Vec3::Unit(i / 2 % 3) : random_point(random);
    const double reach = scale * std::pow(10, random.uniform(-1, 3));
    bool visited = false;
    met += bvh.visit_segment(middle - reach * direction, middle + reach * direction, [&](Index k) {
      visited = visited || k == t;
      return true;
    });
    ASSERT_TRUE(visited);
  }
  EXPECT_EQ(met, 200U);
}

TEST_P(BvhAnywhere, FindsTheDistanceOfTwoMeshes) {
  const auto& [name, scale, shift] = GetParam();
  const TriangleMesh a = moved(soup(60), scale, shift);
  const TriangleMesh b =
      moved(make_torus(0.3, 10, 6), 0.5 * scale, shift + Vec3(2.5, 1, 0) * scale);
  double expected = HUGE_VAL;
  const TriangleBvh a_bvh(a);
  const TriangleBvh b_bvh(b);
  for (Index i = 0; i < a.triangles.size(); ++i) {
    for (Index j = 0; j < b.triangles.size(); ++j) {
      expected = std::min(expected, triangle_triangle_distance(a_bvh.corners(i), b_bvh.corners(j)));
    }
  }
  const MeshDistance distance = mesh_distance(a_bvh, b_bvh);
  EXPECT_NEAR(distance.distance, expected, 1e-12 * scale);
  EXPECT_NEAR(triangle_triangle_distance(a_bvh.corners(distance.triangle_a),
                                         b_bvh.corners(distance.triangle_b)),
              expected, 1e-12 * scale);
  EXPECT_NEAR(mesh_distance(b_bvh, a_bvh).distance, expected, 1e-12 * scale);
  EXPECT_EQ(mesh_distance(a_bvh, b_bvh, expected / 2).triangle_a, NearestPoint::none);
}

INSTANTIATE_TEST_SUITE_P(Places, BvhAnywhere,
                         testing::Values(Placed{"unit", 1, Vec3::Zero()},
                                         Placed{"tiny", 1e-6, Vec3(1e-5, 0, 0)},
                                         Placed{"huge", 1e6, Vec3(0, -3e7, 0)},
                                         Placed{"far", 1, Vec3(1e6, 1e6, -1e6)}),
                         testing::PrintToStringParamName());

TEST(OverlappingPairs, AreThoseOfTheBoxes) {
  const TriangleMesh a = soup(300);
  const TriangleMesh b = soup(200);
  const auto self = overlapping_pairs(TriangleBvh(a));
  const auto other = overlapping_pairs(TriangleBvh(a), TriangleBvh(b));
  EXPECT_TRUE(std::is_sorted(self.begin(), self.end()));
  EXPECT_TRUE(std::is_sorted(other.begin(), other.end()));
  std::size_t expected_self = 0;
  std::size_t expected_other = 0;
  for (Index i = 0; i < a.triangles.size(); ++i) {
    for (Index j = i + 1; j < a.triangles.size(); ++j) {
      if (box_of(a, i).intersects(box_of(a, j))) {
        ++expected_self;
        ASSERT_TRUE(std::binary_search(self.begin(), self.end(), std::pair(i, j)));
      }
    }
    for (Index j = 0; j < b.triangles.size(); ++j) {
      if (box_of(a, i).intersects(box_of(b, j))) {
        ++expected_other;
        ASSERT_TRUE(std::binary_search(other.begin(), other.end(), std::pair(i, j)));
      }
    }
  }
  EXPECT_LE(self.size(), expected_self + 5);
  EXPECT_LE(other.size(), expected_other + 5);
}

TEST(TriangleBvh, StopsAVisitWhenTold) {
  const TriangleBvh bvh(make_icosphere(2));
  int visits = 0;
  EXPECT_FALSE(
      bvh.visit_box(Box3(Vec3(-2, -2, -2), Vec3(2, 2, 2)), [&](Index) { return ++visits < 5; }));
  EXPECT_EQ(visits, 5);
}

TEST(TriangleBvh, OfNothingFindsNothing) {
  const TriangleBvh bvh{TriangleMesh()};
  EXPECT_TRUE(bvh.empty());
  EXPECT_FALSE(bvh.nearest({0, 0, 0}));
  EXPECT_FALSE(bvh.first_hit({0, 0, 0}, {1, 0, 0}));
  EXPECT_TRUE(bvh.visit_box(Box3(Vec3(0, 0, 0), Vec3(1, 1, 1)), [](Index) { return false; }));
}

TEST(TriangleBvh, LeavesOutWhatIsNotANumber) {
  TriangleMesh mesh = make_cube();
  mesh.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  mesh.positions.emplace_back(std::numeric_limits<double>::infinity(), 0, 0);
  mesh.triangles.insert(mesh.triangles.begin(), {{0, 1, 8}, {0, 1, 9}});
  const TriangleBvh bvh(mesh);
  const NearestPoint nearest = bvh.nearest({0.2, 0.3, 3});
  EXPECT_EQ(nearest.distance, 2);
  EXPECT_GE(nearest.triangle, 2U);
  EXPECT_FALSE(bvh.nearest({std::nan(""), 0, 0}));
  EXPECT_EQ(mesh_distance(bvh, TriangleBvh(moved(make_cube(), 1, {4, 0, 0}))).distance, 2);
}

TEST(TriangleBvh, SurvivesAllTrianglesInOnePoint) {
  TriangleMesh mesh;
  mesh.positions.assign(3, Vec3(1, 2, 3));
  mesh.triangles.assign(5000, {0, 1, 2});
  EXPECT_EQ(TriangleBvh(mesh).nearest({1, 2, 5}).distance, 2);
}

TEST(TriangleBvh, SurvivesSizesThatGrowWithoutEnd) {
  // Each triangle twice as far out as the one before: splits at the middle bring little.
  TriangleMesh mesh;
  for (Index i = 0; i < 200; ++i) {
    const double x = std::ldexp(1.0, static_cast<int>(i) - 150);
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x, x, 0}, {x, 0, x}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TriangleBvh bvh(mesh);
  EXPECT_EQ(bvh.nearest({0.9, 0, 0}).triangle, 150U);
}

TEST(FirstHit, SeesTheNearSideOfASphere) {
  const TriangleMesh sphere = make_icosphere(4);
  const TriangleBvh bvh(sphere);
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Vec3 direction = random_point(random).normalized();
    const RayHit hit = bvh.first_hit(-5 * direction, 2 * direction);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit.distance, 2, 1e-2);
    EXPECT_LT(triangle_normal(sphere, sphere.triangles[hit.triangle]).dot(direction), 0);
    EXPECT_FALSE(bvh.first_hit(-5 * direction, 2 * direction, 1.9));
    EXPECT_FALSE(bvh.first_hit(5 * direction, direction));
  }
}

TEST(TriangleBvh, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = make_torus(0.3, 200, 100);
  const auto distances = [&](int threads) {
    return tbb::task_arena(threads).execute([&] {
      const TriangleBvh bvh(mesh);
      Random random(6);
      std::vector<Index> found;
      for (int i = 0; i < 300; ++i) {
        found.push_back(bvh.nearest(random_point(random)).triangle);
      }
      found.push_back(mesh_distance(bvh, TriangleBvh(moved(mesh, 1, {0, 0, 3}))).triangle_a);
      return found;
    });
  };
  EXPECT_EQ(distances(1), distances(2));
}

} // namespace
} // namespace cagewright
