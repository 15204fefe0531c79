#include <cagewright/validate/webbing.h>

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace cagewright {
namespace {

/// From corner to corner.
TriangleMesh bar(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh = make_cube(); // from -1 to 1
  for (Vec3& p : mesh.positions) {
    p = (low + high) / 2 + p.cwiseProduct(high - low) / 2;
  }
  return mesh;
}

/// Two legs, a tenth of the diagonal apart, and what joins them at the top.
TriangleMesh trousers() {
  return joined(joined(bar({-3, 0, 0}, {-1, 2, 16}), bar({1, 0, 0}, {3, 2, 16})),
                bar({-3, 0, 14}, {3, 2, 18}));
}

TEST(SpaceBetween, IsBetweenTheLegs) {
  const SpaceBetween space(trousers());
  ASSERT_GT(space.count(), 100U);
  for (const Vec3& p : space.points()) {
    EXPECT_LT(std::abs(p.x()), 1);
    EXPECT_GT(p.z(), -0.5);
    EXPECT_LT(p.z(), 14);
  }
}

TEST(SpaceBetween, KnowsWhatIsJoined) {
  const SpaceBetween space(trousers());
  EXPECT_EQ(space.share_inside(bar({-4, -1, -1}, {4, 3, 19})), 1);
  EXPECT_EQ(space.share_inside(trousers()), 0);
  // A sheet between the legs, from the top to the middle. Near the top the way is not far.
  const TriangleMesh sheet = bar({-1, -1, 8}, {1, 3, 16});
  EXPECT_NEAR(space.share_inside(sheet), 0.35, 0.1);
}

TEST(SpaceBetween, OfAHalfIsWhatLiesOnItsSide) {
  const SpaceBetween space(trousers());
  const SpaceBetween half = space.right_half();
  const std::vector<Vec3> points = space.points();
  EXPECT_EQ(half.count(), static_cast<std::size_t>(std::ranges::count_if(
                              points, [](const Vec3& p) { return p.x() > 0; })));
  EXPECT_GT(half.count(), 50U);
  for (const Vec3& p : half.points()) {
    EXPECT_GT(p.x(), 0);
  }
  // Half a surface, open on the plane: what it is open to is not counted.
  TriangleMesh box = bar({0, -1, -1}, {4, 3, 19});
  std::erase_if(box.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return box.positions[v].x() == 0; });
  });
  EXPECT_EQ(box.triangles.size(), 10U);
  EXPECT_EQ(half.share_inside(box), 1);
  EXPECT_EQ(SpaceBetween().right_half().count(), 0U);
}

TEST(SpaceBetween, SeesSheetsBetweenTheTipsOfSpreadArms) {
  // Eight arms of a length of 10 all round, as of an octopus: between two tips the gap is a quarter
  // of the diagonal, and the way round it 2.6 times as long.
  TriangleMesh star;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * std::numbers::pi / 4;
    TriangleMesh arm = bar({0, -0.5, -0.5}, {10, 0.5, 0.5});
    for (Vec3& p : arm.positions) {
      p = Vec3(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
               std::sin(angle) * p.x() + std::cos(angle) * p.y(), p.z());
    }
    star = k == 0 ? arm : joined(star, arm);
  }
  const SpaceBetween space(star);
  ASSERT_GT(space.count(), 100U);
  // A sheet over three arms from tip to tip: two gaps of eight.
  TriangleMesh sheet = make_cube();
  sheet.positions = {};
  for (const double z : {-1.0, 1.0}) {
    for (const double angle : {-1.0, 0.0, 1.0}) {
      sheet.positions.emplace_back(10 * std::cos(angle * std::numbers::pi / 4),
                                   10 * std::sin(angle * std::numbers::pi / 4), z);
    }
    sheet.positions.emplace_back(0, 0, z);
  }
  sheet.triangles = {{2, 1, 0}, {3, 2, 0}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                     {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  EXPECT_NEAR(space.share_inside(sheet), 0.25, 0.05);
  EXPECT_EQ(space.share_inside(star), 0);
}

TEST(SpaceBetween, WideGapsDoNotMakeUpForNarrowOnes) {
  // Trousers, and two long arms that leave the hips 45 degrees apart: the free space between those
  // is far larger than between the legs, and still the legs are joined.
  TriangleMesh arms = joined(bar({0, 0, 15}, {16, 2, 17}), bar({0, 0, 15}, {16, 2, 17}));
  for (std::size_t v = 0; v < arms.positions.size() / 2; ++v) {
    const Vec3 p = arms.positions[v] - Vec3(0, 0, 16);
    const double h = std::numbers::sqrt2 / 2;
    arms.positions[v] = Vec3(h * (p.x() - p.z()), p.y(), 16 + h * (p.x() + p.z()));
  }
  const SpaceBetween space(joined(trousers(), arms));
  const TriangleMesh sheet = bar({-1, -1, 0}, {1, 3, 16});
  EXPECT_GT(space.share_inside(sheet), 0.9);
}

TEST(SpaceBetween, IsNotInOneConvexBodyNorInAShallowDent) {
  EXPECT_EQ(SpaceBetween(make_icosphere(3)).count(), 0U);
  const TriangleMesh bent = joined(bar({0, 0, 0}, {10, 2, 2}), bar({0, 0, 0}, {2, 10, 2}));
  EXPECT_EQ(SpaceBetween(bent).count(), 0U);
}

TEST(SpaceBetween, IsBetweenPiecesThatDoNotTouch) {
  const TriangleMesh apart = joined(bar({0, 0, 0}, {4, 4, 4}), bar({5, 0, 0}, {9, 4, 4}));
  EXPECT_GT(SpaceBetween(apart).count(), 100U);
}

TEST(SpaceBetween, DoesNotDependOnUnitAndPlace) {
  const TriangleMesh model = trousers();
  TriangleMesh other = model;
  for (Vec3& p : other.positions) {
    p = 0.01 * p + Vec3(3, -7, 11);
  }
  EXPECT_EQ(SpaceBetween(model).count(), SpaceBetween(other).count());
}

TEST(SpaceBetween, OfAnOpenModelIsThatOfTheClosed) {
  TriangleMesh open = joined(make_icosphere(3), make_icosphere(3));
  for (std::size_t v = 0; v < open.positions.size() / 2; ++v) {
    open.positions[v].x() += 2.3;
  }
  const auto whole = static_cast<double>(SpaceBetween(open).count());
  open.triangles.erase(open.triangles.begin() + 3);
  EXPECT_GT(whole, 100);
  EXPECT_NEAR(static_cast<double>(SpaceBetween(open).count()), whole, 0.02 * whole);
}

TEST(SpaceBetween, OfNothingIsEmpty) {
  EXPECT_EQ(SpaceBetween(TriangleMesh()).count(), 0U);
  TriangleMesh point = make_cube();
  std::fill(point.positions.begin(), point.positions.end(), Vec3(1, 2, 3));
  EXPECT_EQ(SpaceBetween(point).count(), 0U);
  TriangleMesh infinite = make_cube();
  infinite.positions[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(SpaceBetween(infinite).count(), 0U);
}

TEST(SpaceBetween, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh model = trousers();
  std::vector<Vec3> points;
  tbb::task_arena(1).execute([&] { points = SpaceBetween(model).points(); });
  EXPECT_EQ(points, SpaceBetween(model).points());
}

TEST(SpaceBetween, CountsWhatPatchesOfASurfaceEnclose) {
  // The sum over all faces does not depend on how the surface is cut into triangles.
  const SpaceBetween space(trousers());
  const auto inside = [&](const TriangleMesh& mesh) {
    long sum = 0;
    for (const Triangle& t : mesh.triangles) {
      sum += space.behind({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    }
    return sum;
  };
  for (const double edge : {0.37, 1.0, 4.0}) { // at 1 its sides touch the legs
    TriangleMesh ball = make_icosphere(2);
    for (Vec3& p : ball.positions) {
      p = edge * 2 * p + Vec3(0, 1, 7);
    }
    long count = 0;
    for (const Vec3& p : space.points()) {
      bool is_inside = true;
      for (const Triangle& t : ball.triangles) {
        const Vec3 n = triangle_normal(ball, t);
        is_inside = is_inside && n.dot(p - ball.positions[t[0]]) < 0;
      }
      count += is_inside ? 1 : 0;
    }
    EXPECT_EQ(inside(ball), count) << edge;
  }
}

} // namespace
} // namespace cagewright
