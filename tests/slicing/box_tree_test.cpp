#include "slicing/box_tree.h"

#include "grids.h"
#include "slicing/tight_box.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace cagewright {
namespace {

using test::between;
using test::grid_where;

/// A table: a top on four legs of a height of 20.
VoxelGrid table() {
  return grid_where({40, 24, 24}, [](const Vec3& p) {
    const bool leg_x = p.x() < 5 || p.x() >= 35;
    const bool leg_y = p.y() < 5 || p.y() >= 19;
    return p.z() >= 20 || (leg_x && leg_y);
  });
}

/// An elbow: an L of two arms, in the plane z = 0.
VoxelGrid elbow() {
  return grid_where({30, 30, 8}, [](const Vec3& p) { return p.x() < 8 || p.y() < 8; });
}

VoxelGrid ball() {
  return grid_where({24, 24, 24},
                    [](const Vec3& p) { return (p - Vec3(12, 12, 12)).norm() < 11.5; });
}

BoxTree tree_of(const VoxelGrid& grid, const SlicingOptions& options) {
  Result<BoxTree> tree = build_box_tree(grid, options);
  EXPECT_TRUE(tree);
  return tree ? std::move(*tree) : BoxTree{};
}

double total_volume(const BoxTree& tree, int depth) {
  double sum = 0;
  for (const int at : tree.cover(depth)) {
    sum += tree.nodes[static_cast<std::size_t>(at)].box.volume();
  }
  return sum;
}

void expect_corners_inside(const VoxelGrid& grid, const BoxNode& node) {
  for (const Vec3& corner : hull_corners(grid, node.voxels)) {
    EXPECT_TRUE(node.box.contains(corner, -0.2 * grid.size));
  }
}

class BoxTreeBy : public testing::TestWithParam<SlicingRule> {};
INSTANTIATE_TEST_SUITE_P(Rules, BoxTreeBy,
                         testing::Values(SlicingRule::volume, SlicingRule::published),
                         [](const auto& rule) { return std::string(name_of(rule.param)); });

TEST_P(BoxTreeBy, EachCoverHoldsEveryVoxelOnceAndEachBoxItsVoxels) {
  for (const VoxelGrid& grid : {table(), elbow(), ball()}) {
    const BoxTree tree = tree_of(grid, {.rule = GetParam(), .depth = 4});
    for (int depth = 0; depth <= 4; ++depth) {
      std::vector<std::uint32_t> covered;
      for (const int at : tree.cover(depth)) {
        const BoxNode& node = tree.nodes[static_cast<std::size_t>(at)];
        EXPECT_LE(node.depth, depth);
        EXPECT_TRUE(std::is_sorted(node.voxels.begin(), node.voxels.end()));
        covered.insert(covered.end(), node.voxels.begin(), node.voxels.end());
        expect_corners_inside(grid, node);
      }
      std::sort(covered.begin(), covered.end());
      EXPECT_EQ(covered, test::occupied_voxels(grid));
    }
  }
}

TEST_P(BoxTreeBy, DepthZeroIsOneBox) {
  const BoxTree tree = tree_of(table(), {.rule = GetParam(), .depth = 0});
  EXPECT_EQ(tree.nodes.size(), 1U);
  EXPECT_EQ(tree.nodes[0].stop, StopReason::depth);
  EXPECT_FALSE(tree.nodes[0].cut);
}

TEST_P(BoxTreeBy, StrictBinarySplittingMakesAtMostTwoToTheDepth) {
  const BoxTree tree = tree_of(table(), {.rule = GetParam(), .depth = 3, .split_parts = false});
  EXPECT_LE(tree.cover().size(), 8U);
  for (const BoxNode& node : tree.nodes) {
    EXPECT_TRUE(node.children.empty() || node.children.size() == 2);
  }
}

TEST_P(BoxTreeBy, BoxesAreNeverSlivers) {
  for (const VoxelGrid& grid : {table(), elbow(), ball()}) {
    const BoxTree tree = tree_of(grid, {.rule = GetParam(), .depth = 6});
    for (const BoxNode& node : tree.nodes) {
      EXPECT_GE(2 * node.box.half.minCoeff(), 1.5 * grid.size);
    }
  }
}

TEST_P(BoxTreeBy, IsTheSameOnAnyNumberOfThreads) {
  const VoxelGrid grid = table();
  const auto boxes_with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] {
      std::vector<double> numbers;
      for (const BoxNode& node : tree_of(grid, {.rule = GetParam(), .depth = 5}).nodes) {
        for (const Vec3& c : node.box.corners()) {
          numbers.insert(numbers.end(), c.begin(), c.end());
        }
      }
      return numbers;
    });
  };
  EXPECT_EQ(boxes_with(1), boxes_with(2));
  EXPECT_EQ(boxes_with(1), boxes_with(4));
}

TEST_P(BoxTreeBy, StopsWhenAsked) {
  StopFlag stop;
  stop.request_stop();
  const Result<BoxTree> tree = build_box_tree(table(), {.rule = GetParam()}, Progress(stop));
  ASSERT_FALSE(tree);
  EXPECT_EQ(tree.error().code, ErrorCode::cancelled);
}

TEST(BoxTreeByVolume, CutsTheTopOffTheTableAndGivesEachLegABox) {
  const BoxTree tree = tree_of(table(), {.depth = 1});
  EXPECT_EQ(tree.cover(1).size(), 5U);
  // The table holds 40*24*4 + 4*20*25 = 5840 voxels; padding makes the boxes a little larger.
  EXPECT_LT(total_volume(tree, 1), 1.35 * 5840);
}

TEST(BoxTreeByVolume, CutsTheElbowAtItsCorner) {
  const BoxTree tree = tree_of(elbow(), {.depth = 1});
  ASSERT_EQ(tree.cover(1).size(), 2U);
  EXPECT_LT(total_volume(tree, 1), 1.2 * 52 * 8 * 8);
  EXPECT_GT(tree.nodes[0].cut->gain, 0.3);
}

TEST(BoxTreeByVolume, OpensARingThatNoSingleCutGainsFrom) {
  const VoxelGrid ring = grid_where({64, 64, 12}, [](const Vec3& p) {
    const double r = std::hypot(p.x() - 32, p.y() - 32);
    return std::hypot(r - 26, p.z() - 6) < 6;
  });
  const BoxTree tree = tree_of(ring, {.depth = 4});
  EXPECT_LT(total_volume(tree, 4), 0.75 * total_volume(tree, 0));
  for (const int at : tree.cover(4)) {
    EXPECT_FALSE(tree.nodes[static_cast<std::size_t>(at)].box.contains({32, 32, 6}));
  }
}

TEST(BoxTreeByVolume, NeverMakesTheBoxesLarger) {
  for (const VoxelGrid& grid : {table(), elbow(), ball()}) {
    const BoxTree tree = tree_of(grid, {.depth = 5});
    for (int depth = 1; depth <= 5; ++depth) {
      EXPECT_LE(total_volume(tree, depth), total_volume(tree, depth - 1));
    }
  }
}

TEST(BoxTreeByVolume, KeepsToTheNumberOfBoxesAsked) {
  const VoxelGrid grid = ball();
  ASSERT_GT(tree_of(grid, {.depth = 6}).cover().size(), 9U);
  const BoxTree some = tree_of(grid, {.depth = 6, .max_boxes = 9});
  EXPECT_LE(some.cover().size(), 9U);
  EXPECT_GE(some.cover().size(), 7U);
  EXPECT_TRUE(std::any_of(some.nodes.begin(), some.nodes.end(),
                          [](const BoxNode& node) { return node.stop == StopReason::max_boxes; }));
}

TEST(BoxTreeByVolume, LeavesABlockWhole) {
  const VoxelGrid block = grid_where({20, 12, 12}, [](const Vec3&) { return true; });
  const BoxTree tree = tree_of(block, {.depth = 6});
  EXPECT_EQ(tree.nodes.size(), 1U);
  EXPECT_EQ(tree.nodes[0].stop, StopReason::no_gain);
}

TEST(BoxTreeByPublishedRule, CutsTheNeckOfADumbBell) {
  const VoxelGrid dumb_bell = grid_where({36, 10, 10}, [](const Vec3& p) {
    return p.x() < 16 || p.x() >= 24 || between(p, {16, 3, 3}, {24, 7, 7});
  });
  const BoxTree tree = tree_of(dumb_bell, {.rule = SlicingRule::published, .depth = 1});
  ASSERT_TRUE(tree.nodes[0].cut);
  EXPECT_NEAR(tree.nodes[0].cut->jump, 0.84, 0.06); // sampled: a little less than 84 of 100
  const double x = tree.nodes[0].cut->point.x();
  EXPECT_TRUE(std::abs(x - 16) < 0.6 || std::abs(x - 24) < 0.6) << x;
}

TEST(BoxTreeByPublishedRule, SkipsABlockOrCutsItInTheMiddleAsAsked) {
  const VoxelGrid block = grid_where({20, 12, 12}, [](const Vec3&) { return true; });
  const BoxTree skipped =
      tree_of(block, {.rule = SlicingRule::published, .depth = 3, .no_jump = NoJump::skip});
  EXPECT_EQ(skipped.nodes.size(), 1U);
  EXPECT_EQ(skipped.nodes[0].stop, StopReason::no_jump);
  const BoxTree halved =
      tree_of(block, {.rule = SlicingRule::published, .depth = 3, .no_jump = NoJump::middle});
  EXPECT_EQ(halved.cover().size(), 8U);
  EXPECT_TRUE(halved.nodes[0].cut->middle);
}

TEST(BoxTreeByPublishedRule, StopsAtPrismsThatAreNearlyCubesWhenBothTestsAreOn) {
  const VoxelGrid block = grid_where({14, 12, 12}, [](const Vec3&) { return true; });
  SlicingOptions options{.rule = SlicingRule::published, .depth = 3, .eta = 0.8, .zeta = 0.8};
  const BoxTree stopped = tree_of(block, options);
  EXPECT_EQ(stopped.nodes.size(), 1U);
  EXPECT_EQ(stopped.nodes[0].stop, StopReason::prismatic);
  options.zeta = 1.1; // above 1: the test can never hold, so depth alone decides
  EXPECT_GT(tree_of(block, options).nodes.size(), 1U);
}

TEST(BuildBoxTree, RefusesAnEmptyGridAndBadOptions) {
  const VoxelGrid empty = grid_where({3, 3, 3}, [](const Vec3&) { return false; });
  EXPECT_EQ(build_box_tree(empty).error().code, ErrorCode::unfit_model);
  EXPECT_EQ(build_box_tree(table(), {.depth = -1}).error().code, ErrorCode::invalid_option);
  EXPECT_EQ(build_box_tree(table(), {.eta = 0}).error().code, ErrorCode::invalid_option);
}

TEST(BuildBoxTree, GivesPiecesThatAreApartTheirOwnBoxes) {
  const VoxelGrid two =
      grid_where({30, 8, 8}, [](const Vec3& p) { return p.x() < 10 || p.x() >= 20; });
  const BoxTree tree = tree_of(two, {.depth = 1});
  EXPECT_EQ(tree.cover().size(), 2U);
}

} // namespace
} // namespace cagewright
