#include <cagewright/deform/deformer.h>

#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/mean_value.h>
#include <cagewright/deform/stream.h>
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace cagewright {
namespace {

PolygonMesh model() {
  return PolygonMesh(make_torus(0.25, 40, 20));
}
PolygonMesh cage() {
  return PolygonMesh(make_torus(0.4, 10, 6));
}

/// Every cage vertex displaced by a random vector of length up to `size`.
std::vector<Vec3> random_pose(std::span<const Vec3> rest, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> pose(rest.begin(), rest.end());
  for (Vec3& p : pose) {
    p += size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  }
  return pose;
}

double greatest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    greatest = std::max(greatest, (a[i] - b[i]).norm());
  }
  return greatest;
}

Deformer bound(const DeformerOptions& options = {}) {
  Result<Deformer> deformer = Deformer::bind(model(), cage(), options);
  EXPECT_TRUE(deformer) << deformer.error().message;
  return *std::move(deformer);
}

class DeformerWith : public testing::TestWithParam<WeightStorage> {
protected:
  DeformerOptions options{.storage = GetParam()};
  /// What the storage may cost, in the model's units, at displacements of about 1.
  double tolerance() const {
    switch (GetParam()) {
    case WeightStorage::full:
      return 1e-13;
    case WeightStorage::single:
      return 1e-6;
    case WeightStorage::compact:
      return 1e-3;
    }
    return 0;
  }
};

TEST_P(DeformerWith, FollowsAnAffineMapOfTheCage) {
  Deformer deformer = bound(options);
  Mat3 map;
  map << 1.1, 0.2, 0, -0.3, 0.9, 0.1, 0.05, 0, 1.3;
  const Vec3 shift(0.5, -1, 0.25);
  std::vector<Vec3> pose(deformer.cage_positions().begin(), deformer.cage_positions().end());
  for (Vec3& p : pose) {
    p = map * p + shift;
  }
  deformer.set_cage(pose);
  deformer.update();
  for (std::size_t p = 0; p < deformer.positions().size(); ++p) {
    const Vec3 expected = map * deformer.rest_positions()[p] + shift;
    ASSERT_LT((deformer.positions()[p] - expected).norm(), tolerance());
  }
}

TEST_P(DeformerWith, AgreesWithStreamingToWithinItsBound) {
  Deformer deformer = bound(options);
  const std::vector<Vec3> pose = random_pose(deformer.cage_positions(), 0.2, 3);
  deformer.set_cage(pose);
  deformer.update();
  const Result<MeanValueSolver> solver = MeanValueSolver::create(cage());
  ASSERT_TRUE(solver);
  const Result<StreamedPoses> exact =
      deform_streaming(*solver, std::span(&pose, 1), model().positions);
  ASSERT_TRUE(exact);
  const double error = greatest_distance(deformer.positions(), exact->positions[0]);
  EXPECT_LE(error, deformer.position_error_bound() + std::min(tolerance(), 1e-7));
  if (GetParam() == WeightStorage::compact) {
    EXPECT_GT(deformer.position_error_bound(), 0);
    EXPECT_LT(deformer.position_error_bound(), 1e-3);
  }
}

TEST_P(DeformerWith, LeavesTheModelExactlyAtRestInACageAtRest) {
  Deformer deformer = bound(options);
  deformer.set_cage(random_pose(deformer.cage_positions(), 0.2, 4));
  deformer.update();
  EXPECT_GT(greatest_distance(deformer.positions(), deformer.rest_positions()), 0.01);
  deformer.set_cage(cage().positions);
  deformer.update();
  EXPECT_EQ(greatest_distance(deformer.positions(), deformer.rest_positions()), 0);
}

TEST_P(DeformerWith, MovesTheSameInOneStepAndVertexByVertex) {
  Deformer at_once = bound(options);
  Deformer by_steps = bound(options);
  const std::vector<Vec3> pose = random_pose(at_once.cage_positions(), 0.2, 5);
  at_once.set_cage(pose);
  at_once.update();
  for (Index v = 0; v < pose.size(); ++v) {
    by_steps.move_cage_vertex(v, Vec3(9, 9, 9)); // overwritten before it is seen
    by_steps.move_cage_vertex(v, pose[v]);
    by_steps.update();
  }
  EXPECT_LT(greatest_distance(at_once.positions(), by_steps.positions()), 1e-13);
  EXPECT_LT(greatest_distance(at_once.normals(), by_steps.normals()), 1e-4);
}

TEST_P(DeformerWith, TellsHowFarVerticesGoAlong) {
  Deformer deformer = bound(options);
  const std::vector<Index> moved = {2, 17, 40};
  const std::vector<float> influence = deformer.influence(moved);
  const std::vector<Vec3> rest(deformer.positions().begin(), deformer.positions().end());
  for (const Index v : moved) {
    deformer.move_cage_vertex(v, deformer.cage_positions()[v] + Vec3(0, 2, 0));
  }
  deformer.update();
  ASSERT_EQ(influence.size(), rest.size());
  for (std::size_t p = 0; p < rest.size(); ++p) {
    EXPECT_NEAR(deformer.positions()[p].y() - rest[p].y(), 2 * influence[p], 1e-6) << p;
  }
  const std::vector<float> none = deformer.influence({});
  EXPECT_EQ(*std::ranges::max_element(none), 0);
}

INSTANTIATE_TEST_SUITE_P(AllStorages, DeformerWith,
                         testing::Values(WeightStorage::full, WeightStorage::single,
                                         WeightStorage::compact),
                         [](const auto& tested) -> std::string {
                           switch (tested.param) {
                           case WeightStorage::full:
                             return "Full";
                           case WeightStorage::single:
                             return "Single";
                           case WeightStorage::compact:
                             return "Compact";
                           }
                           return "";
                         });

TEST(Deformer, TakesMemoryAsItsStorageSays) {
  const std::size_t numbers = (2 * 512) * 60;
  EXPECT_EQ(bound({.storage = WeightStorage::full}).weight_bytes(), numbers * 8);
  EXPECT_EQ(bound({.storage = WeightStorage::single}).weight_bytes(), numbers * 4);
  EXPECT_EQ(bound({.storage = WeightStorage::compact}).weight_bytes(), numbers * 2);
}

TEST(Deformer, DoesNotMoveBeforeItIsUpdated) {
  Deformer deformer = bound();
  deformer.move_cage_vertex(3, Vec3(5, 5, 5));
  EXPECT_EQ(greatest_distance(deformer.positions(), deformer.rest_positions()), 0);
  EXPECT_EQ(deformer.cage_positions()[3], Vec3(5, 5, 5));
}

TEST(Deformer, UpdatesInPlace) {
  Deformer deformer = bound();
  const Vec3* const positions = deformer.positions().data();
  const Vec3* const normals = deformer.normals().data();
  deformer.set_cage(random_pose(deformer.cage_positions(), 0.2, 6));
  deformer.update();
  deformer.move_cage_vertex(3, Vec3(5, 5, 5));
  deformer.update();
  EXPECT_EQ(deformer.positions().data(), positions);
  EXPECT_EQ(deformer.normals().data(), normals);
}

TEST(Deformer, TurnsNormalsWithTheModel) {
  Deformer deformer = bound({.storage = WeightStorage::full});
  const std::vector<Vec3> before(deformer.normals().begin(), deformer.normals().end());
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vec3> pose = cage().positions;
  for (Vec3& p : pose) {
    p = turn * p;
  }
  deformer.set_cage(pose);
  deformer.update();
  for (std::size_t n = 0; n < before.size(); ++n) {
    ASSERT_LT((deformer.normals()[n] - turn * before[n]).norm(), 1e-10);
  }
}

TEST(Deformer, IsTheSameOnAnyNumberOfThreads) {
  const auto deform = [](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([] {
      Deformer deformer = bound();
      deformer.set_cage(random_pose(deformer.cage_positions(), 0.2, 7));
      deformer.update();
      deformer.move_cage_vertex(2, Vec3(2, 0, 0));
      deformer.update();
      return std::pair(std::vector<Vec3>(deformer.positions().begin(), deformer.positions().end()),
                       std::vector<Vec3>(deformer.normals().begin(), deformer.normals().end()));
    });
  };
  EXPECT_EQ(deform(1), deform(4));
}

TEST(Deformer, LeavesVerticesWithoutWeightsWhereTheyAre) {
  PolygonMesh strange = model();
  strange.positions[7] = Vec3(1e300, 0, 0);
  Result<Deformer> deformer = Deformer::bind(strange, cage());
  ASSERT_TRUE(deformer);
  EXPECT_EQ(deformer->unbound(), 1U);
  deformer->set_cage(random_pose(deformer->cage_positions(), 0.2, 8));
  deformer->update();
  EXPECT_EQ(deformer->positions()[7], strange.positions[7]);
}

TEST(Deformer, RefusesWeightsOfAnotherModel) {
  const Result<Deformer> deformer =
      Deformer::from_weights(model(), vertex_columns(cage().positions), FloatWeights(700, 60));
  ASSERT_FALSE(deformer);
  EXPECT_EQ(deformer.error().message, "the weights are for 700 vertices and 60 columns, the "
                                      "model has 800 and the cage 60");
}

TEST(Deformer, StopsBindingWhenAsked) {
  StopFlag stop;
  stop.request_stop();
  const Result<Deformer> deformer = Deformer::bind(model(), cage(), {}, {}, Progress(stop));
  ASSERT_FALSE(deformer);
  EXPECT_EQ(deformer.error().code, ErrorCode::cancelled);
}

TEST(DeformStreaming, MovesEveryPoseOnItsOwn) {
  const Result<MeanValueSolver> solver = MeanValueSolver::create(cage());
  ASSERT_TRUE(solver);
  const std::vector<Vec3> rest = cage().positions;
  const std::vector<std::vector<Vec3>> poses = {random_pose(rest, 0.1, 1), rest,
                                                random_pose(rest, 0.3, 2)};
  const std::vector<Vec3> points = model().positions;
  const Result<StreamedPoses> together = deform_streaming(*solver, poses, points);
  ASSERT_TRUE(together);
  EXPECT_EQ(together->positions[1], points);
  for (const std::size_t pose : {0U, 2U}) {
    const Result<StreamedPoses> alone =
        deform_streaming(*solver, std::span(poses).subspan(pose, 1), points);
    ASSERT_TRUE(alone);
    EXPECT_EQ(alone->positions[0], together->positions[pose]);
    EXPECT_GT(greatest_distance(alone->positions[0], points), 0.01);
  }
}

TEST(CompactWeights, AreRoundedBlockByBlockToHalfAStep) {
  const PolygonMesh model(make_torus(0.25, 80, 40)); // 3200 vertices in four blocks
  const Result<MeanValueSolver> solver = MeanValueSolver::create(cage());
  ASSERT_TRUE(solver);
  const auto exact = solve_all<float>(*solver, model.positions);
  const auto compact = solve_compact(*solver, model.positions);
  ASSERT_TRUE(exact && compact);
  const CompactWeights same = make_compact(exact->weights);
  EXPECT_EQ(compact->weights.steps, same.steps);
  ASSERT_EQ(same.steps.size(), 4 * cage().positions.size());
  for (std::size_t p = 0; p < model.positions.size(); ++p) {
    const std::span<const double> steps = same.steps_of_tile(p / 512);
    for (std::size_t c = 0; c < steps.size(); ++c) {
      ASSERT_EQ(compact->weights.tiles.at(p, c), same.tiles.at(p, c));
      ASSERT_LE(std::abs(same.tiles.at(p, c) * steps[c] - exact->weights.at(p, c)),
                0.5001 * steps[c]);
    }
  }
}

TEST(CompactWeights, StopWhenAsked) {
  StopFlag stop;
  stop.request_stop();
  const Result<MeanValueSolver> solver = MeanValueSolver::create(cage());
  ASSERT_TRUE(solver);
  const auto compact = solve_compact(*solver, model().positions, Progress(stop));
  ASSERT_FALSE(compact);
  EXPECT_EQ(compact.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright
