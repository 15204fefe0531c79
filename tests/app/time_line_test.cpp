#include "app/document/time_line.h"

#include <gtest/gtest.h>

namespace cagewright::app {
namespace {

Keyframe key(int frame, double x) {
  return {frame, std::make_shared<const std::vector<Vec3>>(1, Vec3(x, 0, 0))};
}

TEST(TimeLine, PassesThroughItsKeyframesAndStandsStillOutside) {
  TimeLine line;
  for (const Keyframe& k : {key(30, 5), key(10, 1), key(20, 4)}) {
    line = with_keyframe(line, k);
  }
  ASSERT_EQ(line.keys.size(), 3U);
  for (const auto& [frame, x] : {std::pair(10, 1.0), {20, 4.0}, {30, 5.0}, {-3, 1.0}, {99, 5.0}}) {
    EXPECT_DOUBLE_EQ(cage_at(line, frame)[0].x(), x) << frame;
  }
}

TEST(TimeLine, IsSmoothAtItsKeyframes) {
  TimeLine line;
  for (const Keyframe& k : {key(0, 0), key(7, 3), key(10, 4), key(30, -2)}) {
    line = with_keyframe(line, k);
  }
  const double h = 1e-4;
  for (const int frame : {7, 10}) {
    const double x = cage_at(line, frame)[0].x();
    const double in = (x - cage_at(line, frame - h)[0].x()) / h;
    const double out = (cage_at(line, frame + h)[0].x() - x) / h;
    EXPECT_NEAR(in, out, 1e-3);
  }
}

TEST(TimeLine, ReplacesAndRemovesKeyframes) {
  TimeLine line = with_keyframe(with_keyframe({}, key(5, 1)), key(5, 2));
  ASSERT_EQ(line.keys.size(), 1U);
  EXPECT_EQ(cage_at(line, 3)[0].x(), 2);
  EXPECT_TRUE(without_keyframe(line, 5).keys.empty());
  EXPECT_EQ(without_keyframe(line, 6).keys.size(), 1U);
  EXPECT_TRUE(cage_at({}, 1).empty());
}

} // namespace
} // namespace cagewright::app
