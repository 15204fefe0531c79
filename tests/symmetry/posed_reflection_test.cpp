#include "symmetry/posed_reflection.h"

#include "core/rotation.h"
#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include "support/posed_figure.h"
#include "symmetry/limb_tips.h"
#include "symmetry/surface_distances.h"
#include "symmetry/symmetric_pose.h"
#include "symmetry/tip_pairings.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

using test::posed_figure;

constexpr int coarse = 3;

TEST(SurfaceDistances, AreThoseAlongASphere) {
  const TriangleMesh sphere = make_icosphere(3);
  const SurfaceDistances distances(sphere);
  for (Index a = 0; a < distances.size(); a += 40) {
    for (Index b = 0; b < distances.size(); ++b) {
      const double angle =
          2 * std::asin(std::min(1.0, (sphere.positions[a] - sphere.positions[b]).norm() / 2));
      EXPECT_NEAR(distances(a, b), angle, 0.03 * angle + 1e-12);
    }
  }
}

TEST(LimbTips, AreFoundInAnyPose) {
  for (const double by : {0.0, 1.0}) {
    const TriangleMesh figure = posed_figure(by, coarse).mesh;
    const std::vector<Index> tips = limb_tips(figure, SurfaceDistances(figure), 10);
    EXPECT_GE(tips.size(), 5U); // and the nose, perhaps
    EXPECT_LE(tips.size(), 6U);
    EXPECT_LE(limb_tips(figure, SurfaceDistances(figure), 3).size(), 3U);
  }
}

TEST(TipPairings, AreMutualAndTheBestSwapsTheLimbs) {
  const test::PosedFigure figure = posed_figure(1, coarse);
  const SurfaceDistances distances(figure.mesh);
  const std::vector<Index> tips = limb_tips(figure.mesh, distances, 10);
  const std::vector<TipPairing> pairings = tip_pairings(tips, distances, 6);
  ASSERT_FALSE(pairings.empty());
  EXPECT_LE(pairings.size(), 6U);
  EXPECT_TRUE(std::ranges::is_sorted(pairings, {}, &TipPairing::cost));
  for (std::size_t i = 0; i < tips.size(); ++i) {
    const std::size_t partner = pairings.front().partners[i];
    ASSERT_LT(partner, tips.size());
    EXPECT_EQ(pairings.front().partners[partner], i);
    const Vec3& known = figure.mesh.positions[figure.partners[tips[i]]];
    EXPECT_LT((figure.mesh.positions[tips[partner]] - known).norm(), 1) << i;
  }
}

TEST(PosedReflection, TakesEveryPlaceToItsPartner) {
  for (const double by : {0.0, 0.5, 1.0}) {
    const test::PosedFigure figure = posed_figure(by, coarse);
    const std::vector<Vec3>& at = figure.mesh.positions;
    const auto map = find_posed_reflection(figure.mesh);
    ASSERT_TRUE(map);
    EXPECT_TRUE(map->is_convincing())
        << map->stretch << ' ' << map->return_error << ' ' << map->uncovered;
    double error = 0;
    for (std::size_t v = 0; v < at.size(); ++v) {
      error += (map->images[v].in(at, figure.mesh.triangles) - at[figure.partners[v]]).norm();
    }
    EXPECT_LT(error / static_cast<double>(at.size()), 0.03 * diagonal(at)) << by;
  }
}

TEST(PosedReflection, DoesNotConvinceWhereAnArmIsMissing) {
  const auto map = find_posed_reflection(posed_figure(1, coarse, 0).mesh);
  ASSERT_TRUE(map);
  EXPECT_NE(map->why_not(), "");
  EXPECT_FALSE(map->is_convincing())
      << map->stretch << ' ' << map->return_error << ' ' << map->uncovered;
}

TEST(PosedReflection, StopsWhenAsked) {
  const StopFlag stop;
  stop.request_stop();
  EXPECT_FALSE(find_posed_reflection(posed_figure(1, coarse).mesh, Progress(stop)));
}

/// Of the vertices' mirror images from the surface, the mean, in diagonals.
double mirror_error(const TriangleMesh& mesh, const MirrorPlane& plane) {
  const TriangleBvh tree(mesh);
  double sum = 0;
  for (const Vec3& p : mesh.positions) {
    sum += tree.nearest(plane.mirrored(p)).distance;
  }
  return sum / static_cast<double>(mesh.positions.size()) / diagonal(mesh.positions);
}

TEST(SymmetricPose, IsNearlyItsOwnMirrorImage) {
  const TriangleMesh figure = posed_figure(1, coarse).mesh;
  const auto map = find_posed_reflection(figure);
  ASSERT_TRUE(map);
  const MirrorFrame frame(map->plane, bounding_box(figure.positions));
  const TriangleMesh pose{symmetric_pose(figure, *map, frame), figure.triangles};
  EXPECT_LT(mirror_error(pose, MirrorPlane()), 0.004);
  EXPECT_GT(mirror_error(figure, map->plane), 0.01);
}

TEST(PoseChange, TakesPointsAlongRigidly) {
  const TriangleMesh from = posed_figure(1, coarse).mesh;
  const Mat3 turn = rotation_about(Vec3(1, 2, 3).normalized(), 0.8);
  const Vec3 shift(3, -1, 2);
  std::vector<Vec3> to;
  for (const Vec3& p : from.positions) {
    to.emplace_back(turn * p + shift);
  }
  const PoseChange change(from, to);
  for (const Vec3& p : from.positions) {
    const Vec3 q = 1.05 * p;
    EXPECT_LT((change(q) - (turn * q + shift)).norm(), 1e-9);
  }
}

} // namespace
} // namespace cagewright
