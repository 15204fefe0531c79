#include <cagewright/core/steady_report.h>

#include <gtest/gtest.h>

#include <vector>

namespace cagewright {
namespace {

std::vector<double> shown(const std::vector<double>& reported) {
  std::vector<double> result;
  const ProgressReport report =
      steady([&](double fraction, std::string_view) { result.push_back(fraction); });
  for (const double fraction : reported) {
    report(fraction, "");
  }
  return result;
}

TEST(SteadyReport, LeavesWhatDoesNotFall) {
  const std::vector<double> reported = {0, 0.1, 0.1, 0.5, 0.75, 1};
  EXPECT_EQ(shown(reported), reported);
}

TEST(SteadyReport, GoesOnWhereAStepBeginsAnew) {
  const std::vector<double> reported = {0, 0.2, 0.6, 0.2, 0.4, 0.6, 0.3, 0.6, 0.6, 0.1, 0.9, 1};
  const std::vector<double> made = shown(reported);
  ASSERT_EQ(made.size(), reported.size());
  for (std::size_t i = 1; i < made.size(); ++i) {
    EXPECT_GE(made[i], made[i - 1]);
    if (reported[i] > reported[i - 1]) { // it never stands while work is done
      EXPECT_GT(made[i], made[i - 1]);
    }
  }
  EXPECT_LT(made[10], 1);
  EXPECT_EQ(made.back(), 1);
}

TEST(SteadyReport, StaysAtTheEndOnceItIsThere) {
  EXPECT_EQ(shown({0.5, 1, 0.2, 1}), (std::vector<double>{0.5, 1, 1, 1}));
}

} // namespace
} // namespace cagewright
