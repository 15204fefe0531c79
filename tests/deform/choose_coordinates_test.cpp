#include <cagewright/deform/choose_coordinates.h>

#include "mesh/shapes.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace cagewright {
namespace {

std::vector<Vec3> torus_inside() {
  std::vector<Vec3> points = make_torus(0.25, 12, 6).positions;
  for (Vec3& p : points) {
    p *= 0.6;
  }
  return points;
}

TEST(ChooseCoordinates, TriesEveryKindAndTakesTheOneWithTheLeastErrors) {
  const Result<ChosenCoordinates> chosen = choose_coordinates(make_quad_cube(), torus_inside());
  ASSERT_TRUE(chosen) << chosen.error().message;
  ASSERT_EQ(chosen->tried.size(), coordinate_kinds().size());
  EXPECT_EQ(&chosen->settings.kind(), chosen->tried.front().kind);
  for (const TriedKind& tried : chosen->tried) {
    EXPECT_EQ(tried.refusal, "") << tried.kind->name;
    EXPECT_GE(tried.cost(), chosen->tried.front().cost()) << tried.kind->name;
    EXPECT_EQ(tried.drag, 0) << tried.kind->name; // the cage is convex
  }
}

TEST(ChooseCoordinates, LeavesOutKindsThatCannotCarryTheModel) {
  std::vector<Vec3> points = torus_inside();
  points.emplace_back(0, 0, 1.5); // outside
  const Result<ChosenCoordinates> chosen = choose_coordinates(make_quad_cube(), points);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(chosen->tried.front().refusal, "");
  EXPECT_EQ(chosen->settings.kind().outside, "everywhere");
  EXPECT_TRUE(
      std::ranges::any_of(chosen->tried, [](const TriedKind& t) { return !t.refusal.empty(); }));
}

TEST(ChooseCoordinates, SaysWhyNoneCan) {
  const std::vector<Vec3> none = {Vec3::Constant(std::numeric_limits<double>::quiet_NaN())};
  const Result<ChosenCoordinates> chosen = choose_coordinates(make_quad_cube(), none);
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().code, ErrorCode::invalid_cage);
}

TEST(ChooseCoordinates, ChoosesAlikeOnAnyNumberOfThreads) {
  const auto with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([] { return choose_coordinates(make_quad_cube(), torus_inside()); });
  };
  const auto one = with(1);
  const auto four = with(4);
  ASSERT_TRUE(one && four);
  for (std::size_t i = 0; i < one->tried.size(); ++i) {
    EXPECT_EQ(one->tried[i].kind, four->tried[i].kind);
    EXPECT_EQ(one->tried[i].cost(), four->tried[i].cost());
  }
}

} // namespace
} // namespace cagewright
