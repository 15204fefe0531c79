// What holds however a cage is made: progress tells the truth, the computation stops soon when it
// is asked to, and the engine is not run more often than is promised.
#include "mesh/shapes.h"
#include "support/figures.h"
#include "support/polls.h"
#include <cagewright/cage/generate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

namespace cagewright {
namespace {

struct Mode {
  std::string name;
  GenerateOptions options;
};

GenerateOptions quick(int vertices) {
  GenerateOptions options;
  options.vertices = vertices;
  options.rounds = 1;
  options.resolution = 24;
  options.depth = 2;
  return options;
}

std::vector<Mode> every_mode() {
  std::vector<Mode> modes;
  const auto add = [&](const char* name, int vertices) -> GenerateOptions& {
    return modes.emplace_back(Mode{name, quick(vertices)}).options;
  };
  add("Triangles", 24);
  add("Quads", 24).quads = true;
  add("Boxes", 24).method = Method::boxes;
  add("BoxesImproved", 24).method = Method::boxes_improved;
  add("PiecesApart", 24).pieces = Pieces::apart;
  add("WithinAGap", 0).max_gap = 0.15;
  GenerateOptions& gap = add("QuadsWithinAGap", 0);
  gap.max_gap = 0.15;
  gap.quads = true;
  GenerateOptions& faces = add("SoManyFaces", 0);
  faces.faces = 24;
  faces.quads = true;
  add("TooFewVertices", 8);
  return modes;
}

void PrintTo(const Mode& mode, std::ostream* out) {
  *out << mode.name;
}

/// Two bodies, each the other's mirror image.
TriangleMesh model() {
  return joined(test::ellipsoid({-1.5, 0, 0}, {1, 0.8, 0.6}),
                test::ellipsoid({1.5, 0, 0}, {1, 0.8, 0.6}));
}

class EveryMode : public testing::TestWithParam<Mode> {};

// Seconds are those of the process: how busy the machine is does not matter.
TEST_P(EveryMode, ShowsHowMuchIsDoneAndStopsSoon) {
  test::Polls polls;
  const Result<GeneratedCage> made = generate(model(), GetParam().options, polls.progress());
  polls.end();
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<test::Polls::Shown>& shown = polls.shown();

  ASSERT_FALSE(shown.empty());
  EXPECT_GE(shown.front().fraction, 0);
  EXPECT_EQ(shown.back().fraction, 1);
  const auto falls = std::ranges::adjacent_find(
      shown, [](const auto& a, const auto& b) { return b.fraction < a.fraction; });
  EXPECT_EQ(falls, shown.end());

  // Who knows how much is done, and how long that took, knows about how long it will take in all.
  constexpr double told = 0.2; // before that nothing is said of what is left
  constexpr double factor = 5;
  for (const test::Polls::Shown& at : shown) {
    if (at.fraction < told || at.fraction == 1) {
      continue;
    }
    const double reckoned = at.seconds / at.fraction / polls.seconds();
    ASSERT_LT(reckoned, factor) << "at " << at.fraction << ", " << at.step;
    ASSERT_GT(reckoned, 1 / factor) << "at " << at.fraction << ", " << at.step;
  }

  constexpr double most = 0.25; // of all the work, between two questions
  EXPECT_LT(polls.longest().front().seconds, most * polls.seconds())
      << polls.longest().front().step;

  for (const double share : {0.0, 0.5}) { // asked to stop, it does
    const auto k = static_cast<std::size_t>(share * static_cast<double>(polls.count())) + 1;
    test::Polls stopping(k);
    const Result<GeneratedCage> none = generate(model(), GetParam().options, stopping.progress());
    stopping.end();
    ASSERT_FALSE(none) << "at " << share;
    EXPECT_EQ(none.error().code, ErrorCode::cancelled) << "at " << share;
    EXPECT_LT(stopping.seconds_to_end(), most * polls.seconds()) << "at " << share;
  }
}

std::string name_of(const testing::TestParamInfo<Mode>& mode) {
  return mode.param.name;
}

INSTANTIATE_TEST_SUITE_P(Generate, EveryMode, testing::ValuesIn(every_mode()), name_of);

} // namespace
} // namespace cagewright
