#include "slicing/published_rule.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

CrossSection section(int axis, std::vector<double> f) {
  CrossSection s;
  s.axis = axis;
  s.first = -0.5 * static_cast<double>(f.size()) + 0.5;
  s.step = 1;
  s.area = f;
  s.smooth = std::move(f);
  return s;
}

const OrientedBox box{{0, 0, 0}, Mat3::Identity(), {4, 3, 2}};
const std::vector<double> flat(8, 5.0);
const std::vector<double> stepped = {5, 5, 5, 5, 2, 2, 2, 2};

TEST(PublishedCuts, TakeTheLongestAxisThatHasAClearJumpFirst) {
  const auto cuts =
      published_cuts(box, {section(0, stepped), section(1, stepped), section(2, flat)});
  ASSERT_EQ(cuts.size(), 3U);
  EXPECT_EQ(cuts[0].plane.axis, 0);
  EXPECT_DOUBLE_EQ(cuts[0].plane.offset, 0);
  EXPECT_DOUBLE_EQ(cuts[0].jump, 0.6);
  EXPECT_EQ(cuts[1].plane.axis, 1);
  EXPECT_TRUE(cuts[2].middle);
}

TEST(PublishedCuts, PassOverAnAxisWithoutAClearJump) {
  const auto cuts = published_cuts(box, {section(0, flat), section(1, stepped), section(2, flat)});
  ASSERT_FALSE(cuts.empty());
  EXPECT_EQ(cuts[0].plane.axis, 1);
}

TEST(PublishedCuts, FallBackToTheMiddleOrSkipAsAsked) {
  const std::array<CrossSection, 3> none = {section(0, flat), section(1, flat), section(2, flat)};
  const auto middle = published_cuts(box, none, {.no_jump = NoJump::middle});
  ASSERT_EQ(middle.size(), 1U);
  EXPECT_TRUE(middle[0].middle);
  EXPECT_EQ(middle[0].plane.axis, 0);
  EXPECT_DOUBLE_EQ(middle[0].plane.offset, 0);
  EXPECT_TRUE(published_cuts(box, none, {.no_jump = NoJump::skip}).empty());
}

TEST(PublishedCuts, LeaveABoxThatIsTooThinAlone) {
  const std::array<CrossSection, 3> thin = {section(0, {1, 1, 1}), section(1, {1}),
                                            section(2, {1})};
  EXPECT_TRUE(published_cuts(box, thin, {.no_jump = NoJump::middle}).empty());
}

TEST(PrismaticRatio, LooksAwayFromTheTaperedEnds) {
  EXPECT_DOUBLE_EQ(prismatic_ratio(section(0, {1, 2, 8, 10, 9, 8, 2, 1}), 2), 0.8);
  EXPECT_DOUBLE_EQ(prismatic_ratio(section(0, {3, 1}), 2), 1);
}

TEST(CubeRatio, IsShortestOverLongest) {
  EXPECT_DOUBLE_EQ(cube_ratio(box), 0.5);
}

} // namespace
} // namespace cagewright
