#include "cage/unite.h"

#include <cagewright/mesh/measures.h>

#include <tbb/task_arena.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <vector>

namespace cagewright {
namespace {

using Solids = std::vector<Hexahedron>;

Hexahedron box(const Vec3& center, const Vec3& half, const Mat3& axes = Mat3::Identity()) {
  return make_box(center, axes, half);
}

/// Vertices minus edges plus faces: 2 for each sphere, 0 for a torus.
int euler_characteristic(const TriangleMesh& mesh) {
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    }
  }
  return static_cast<int>(mesh.positions.size() + mesh.triangles.size()) -
         static_cast<int>(edges.size());
}

/// Every directed edge once, its opposite too, and the triangles of each vertex in one fan.
void expect_closed_manifold(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, Index> next; // from edge (v, a) of triangle (v, a, b) to b
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(next.try_emplace({t[i], t[(i + 1) % 3]}, t[(i + 2) % 3]).second);
    }
  }
  std::vector<int> degree(mesh.positions.size(), 0);
  std::vector<Index> start(mesh.positions.size(), 0);
  for (const auto& [edge, third] : next) {
    ASSERT_TRUE(next.contains({edge.second, edge.first}));
    ++degree[edge.first];
    start[edge.first] = edge.second;
  }
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    ASSERT_GT(degree[v], 0);
    int fan = 0;
    Index at = start[v];
    do {
      at = next.at({v, at});
      ++fan;
    } while (at != start[v]);
    EXPECT_EQ(fan, degree[v]);
  }
}

/// How often the mesh winds round the point, by the solid angles of its triangles.
double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double angle = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]] - point;
    const Vec3 b = mesh.positions[t[1]] - point;
    const Vec3 c = mesh.positions[t[2]] - point;
    angle +=
        2 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                              b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle / (4 * std::numbers::pi);
}

bool contains_some(const Solids& solids, const Vec3& point, double margin) {
  return std::any_of(solids.begin(), solids.end(),
                     [&](const Hexahedron& s) { return height_above(s, point) < margin; });
}

TriangleMesh united(const Solids& solids, const UniteOptions& options = {}) {
  const Result<TriangleMesh> mesh = unite(solids, options);
  EXPECT_TRUE(mesh) << mesh.error().message;
  if (!mesh) {
    return {};
  }
  expect_closed_manifold(*mesh);
  return *mesh;
}

Mat3 random_axes(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

Solids random_cloud(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Solids solids(3 + random() % 10);
  for (Hexahedron& solid : solids) {
    const Vec3 center(uniform(random), uniform(random), uniform(random));
    const Vec3 half(uniform(random), uniform(random), uniform(random));
    solid = box(2 * center, 0.6 * half + Vec3::Constant(0.1), random_axes(random));
  }
  return solids;
}

constexpr UniteOptions slight = {.separation = 1e-3};

TEST(Unite, OfOneBoxIsThatBoxMadeLarger) {
  const TriangleMesh mesh = united({box(Vec3(5, 0, 0), Vec3(1, 2, 3))}, {.separation = 0.25});
  EXPECT_EQ(mesh.positions.size(), 8);
  EXPECT_EQ(mesh.triangles.size(), 12);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 8 * 1.25 * 2.25 * 3.25);
}

TEST(Unite, OfTwoBoxesHasTheVolumeOfBothLessTheOverlap) {
  const TriangleMesh mesh =
      united({box(Vec3::Zero(), Vec3::Ones()), box(Vec3(1, 1.25, 1.5), Vec3::Ones())},
             {.separation = 1e-9});
  EXPECT_NEAR(signed_volume(mesh), 16 - 1 * 0.75 * 0.5, 1e-7);
  EXPECT_EQ(euler_characteristic(mesh), 2);
}

TEST(Unite, OfACrossHasNoVertexWithinAFlatFaceOrAStraightEdge) {
  const TriangleMesh mesh =
      united({box(Vec3::Zero(), Vec3(3, 1, 0.5)), box(Vec3::Zero(), Vec3(1, 3, 1)),
              box(Vec3::Zero(), Vec3(0.7, 0.8, 4))});
  // 8 corners of each box, and 8 where the bars meet each other, twice.
  EXPECT_EQ(mesh.positions.size(), 3 * 8 + 2 * 8);
}

TEST(Unite, OfRandomCloudsIsAManifoldOfTheRightVolumeRoundAllBoxes) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Solids solids = random_cloud(random);
    const TriangleMesh mesh = united(solids, slight);
    std::uniform_real_distribution<double> uniform(-1, 3);
    int hits = 0;
    constexpr int samples = 400;
    for (int i = 0; i < samples; ++i) {
      const Vec3 p(uniform(random), uniform(random), uniform(random));
      const double winding = winding_number(mesh, p);
      hits += winding > 0.5 ? 1 : 0;
      EXPECT_NEAR(winding, std::round(winding), 1e-6);
      if (contains_some(solids, p, 0)) {
        EXPECT_NEAR(winding, 1, 1e-6); // 1 also where many overlap: no inner wall
      }
    }
    const double expected = signed_volume(mesh) / 64;
    EXPECT_NEAR(hits / double(samples), expected, 5 * std::sqrt(expected / samples));
    for (const Hexahedron& solid : solids) {
      for (const Vec3& corner : solid.corners) {
        EXPECT_NEAR(winding_number(mesh, corner), 1, 1e-6);
      }
    }
  }
}

TEST(Unite, OfIdenticalBoxesIsOneBox) {
  const Mat3 axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const TriangleMesh mesh = united(Solids(5, box(Vec3(1, 2, 3), Vec3(3, 2, 1), axes)), slight);
  EXPECT_EQ(mesh.triangles.size(), 12);
}

TEST(Unite, OfIdenticalSharedSolidsIsOneSolidThoughNoneMayMove) {
  Hexahedron fixed = box(Vec3(1, 2, 3), Vec3(3, 2, 1));
  fixed.shared = {true, true};
  const TriangleMesh mesh = united(Solids(4, fixed), slight);
  EXPECT_EQ(mesh.triangles.size(), 12);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 48);
}

TEST(Unite, OfNestedBoxesIsTheOuterOne) {
  const TriangleMesh mesh =
      united({box(Vec3::Zero(), Vec3::Ones()), box(Vec3(0.1, 0, 0), Vec3::Constant(0.5)),
              box(Vec3::Zero(), Vec3::Constant(2))},
             slight);
  EXPECT_EQ(mesh.triangles.size(), 12);
}

TEST(Unite, OfBoxesThatTouchInAFaceAnEdgeOrACornerIsOneManifold) {
  for (const Vec3& offset : {Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(2, 2, 2)}) {
    for (const Mat3& axes :
         {Mat3(Mat3::Identity()), Mat3(Eigen::AngleAxisd(1, Vec3(1, 1, 3).normalized()))}) {
      const TriangleMesh mesh = united(
          {box(Vec3::Zero(), Vec3::Ones(), axes), box(axes * offset, Vec3::Ones(), axes)}, slight);
      EXPECT_EQ(euler_characteristic(mesh), 2); // one sphere, not two
    }
  }
}

TEST(Unite, OfAStackInOneFrameHasNoDegenerateTriangle) {
  const Mat3 axes = Eigen::AngleAxisd(0.3, Vec3(3, 1, 2).normalized()).toRotationMatrix();
  Solids stack;
  for (int i = 0; i < 27; ++i) {
    stack.push_back(
        box(axes * Vec3(2 * (i % 3), 2 * (i / 3 % 3), 2 * (i / 9)), Vec3::Ones(), axes));
  }
  const TriangleMesh mesh = united(stack, {.separation = 0.05});
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_GT(signed_volume(mesh), 216);
  EXPECT_LT(signed_volume(mesh), std::pow(6.1, 3));
}

TEST(Unite, FillsAnEnclosedCavityAndWhatIsInIt) {
  Solids hollow;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      hollow.push_back(
          box(2 * side * Vec3::Unit(axis), Vec3::Constant(2.25) - 2 * Vec3::Unit(axis)));
    }
  }
  const TriangleMesh shell = united(hollow, slight);
  EXPECT_EQ(euler_characteristic(shell), 2);
  EXPECT_NEAR(signed_volume(shell), 4.5 * 4.5 * 4.5, 0.2);
  hollow.push_back(box(Vec3::Zero(), Vec3::Constant(0.5)));
  const TriangleMesh filled = united(hollow, slight);
  EXPECT_EQ(euler_characteristic(filled), 2);
  EXPECT_NEAR(winding_number(filled, Vec3(0.1, 0.2, 0.9)), 1, 1e-6);
}

TEST(Unite, KeepsTheTunnelOfARing) {
  Solids ring;
  for (int i = 0; i < 8; ++i) {
    const Mat3 axes = Eigen::AngleAxisd(i * std::numbers::pi / 4, Vec3::UnitZ()).toRotationMatrix();
    ring.push_back(box(axes * Vec3(3, 0, 0), Vec3(0.5, 1.5, 0.5), axes));
  }
  const TriangleMesh mesh = united(ring, slight);
  EXPECT_EQ(euler_characteristic(mesh), 0);
  EXPECT_NEAR(winding_number(mesh, Vec3::Zero()), 0, 1e-6);
}

TEST(Unite, ReturnsSolidsThatAreApartAsComponents) {
  const TriangleMesh mesh =
      united({box(Vec3::Zero(), Vec3::Ones()), box(Vec3(10, 0, 0), Vec3::Ones()),
              box(Vec3(0, 10, 0), Vec3::Ones())});
  EXPECT_EQ(euler_characteristic(mesh), 6);
  EXPECT_EQ(mesh.triangles.size(), 36);
}

TEST(Unite, OfTwoSolidsThatShareAFaceLeavesNothingOfIt) {
  Hexahedron left = box(Vec3(-1, 0, 0), Vec3::Ones());
  Hexahedron right = box(Vec3(1, 0, 0), Vec3::Ones());
  for (int i = 0; i < 8; i += 2) { // the joint is wider than the far ends, and a little oblique
    left.corners[i + 1] = right.corners[i] =
        left.corners[i + 1].cwiseProduct(Vec3(1, 1.2, 1.3)) + Vec3(0, 0.1, 0.05);
  }
  left.shared[1] = right.shared[0] = true;
  left.is_box = right.is_box = false;
  const TriangleMesh mesh = united({left, right}, slight);
  EXPECT_EQ(mesh.positions.size(), 12);
  EXPECT_EQ(mesh.triangles.size(), 20);
}

TEST(Unite, TurnsSolidsThatAreInsideOut) {
  Mat3 left_handed = Mat3::Identity();
  left_handed(0, 0) = -1;
  const TriangleMesh mesh =
      united({box(Vec3::Zero(), Vec3::Ones(), left_handed)}, {.separation = 0.5});
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 27);
}

TEST(Unite, IsTheSameAtAnySizeAndPlace) {
  std::mt19937 random(7);
  const Solids solids = random_cloud(random);
  const TriangleMesh mesh = united(solids);
  for (const double scale : {0x1p-20, 0x1p20}) {
    Solids scaled = solids;
    for (Hexahedron& solid : scaled) {
      for (Vec3& corner : solid.corners) {
        corner *= scale;
      }
    }
    const TriangleMesh same = united(scaled);
    EXPECT_EQ(same.triangles, mesh.triangles);
    EXPECT_NEAR(signed_volume(same), signed_volume(mesh) * std::pow(scale, 3),
                1e-9 * std::pow(scale, 3));
  }
}

TEST(Unite, DoesNotDependOnTheNumberOfThreads) {
  std::mt19937 random(11);
  Solids solids = random_cloud(random);
  const Solids more = random_cloud(random);
  solids.insert(solids.end(), more.begin(), more.end());
  std::vector<TriangleMesh> meshes;
  for (const int threads : {1, 2, 4, 4}) {
    tbb::task_arena(threads).execute([&] { meshes.push_back(united(solids)); });
  }
  for (const TriangleMesh& mesh : meshes) {
    EXPECT_EQ(mesh.triangles, meshes[0].triangles);
    EXPECT_EQ(mesh.positions, meshes[0].positions);
  }
}

TEST(Unite, RejectsWhatIsNoSolid) {
  const auto code = [](const Solids& solids) { return unite(solids).error().code; };
  EXPECT_EQ(code({}), ErrorCode::invalid_option);
  EXPECT_EQ(code({box(Vec3::Zero(), Vec3(1, 1, 0))}), ErrorCode::invalid_option);
  EXPECT_EQ(code({box(Vec3(NAN, 0, 0), Vec3(1, 1, 1))}), ErrorCode::invalid_option);
}

TEST(Unite, StopsWhenAskedTo) {
  StopFlag stop;
  stop.request_stop();
  const Solids solids(2, box(Vec3::Zero(), Vec3::Ones()));
  EXPECT_EQ(unite(solids, {}, Progress(stop)).error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
