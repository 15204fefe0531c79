#include <cagewright/coordinates/mixed.h>

#include "coordinates/laws.h"

#include <algorithm>

namespace cagewright {
namespace {

using namespace cagewright::test;

CoordinateSettings both(const CoordinateKind& first, const CoordinateKind& second) {
  CoordinateSettings settings(first);
  settings.mix_with(CoordinateSettings(second));
  return settings;
}

/// Every two kinds, quickly made.
class Mixed : public testing::Test {
protected:
  const PolygonMesh cage_ = golden_cube();
  const std::vector<Vec3> points_ = points_inside(cage_, 20, 61);
  std::vector<Vec3> pose_ = golden_pose();
};

TEST_F(Mixed, GoesBetweenWhereTheTwoTakeAPoint) {
  for (const auto& [first, second] :
       {std::pair("mean_value", "green"), std::pair("green", "quad_green"),
        std::pair("maximum_entropy", "mean_value"),
        std::pair("somigliana", "maximum_likelihood")}) {
    const CoordinateKind& a = *find_coordinate_kind(first);
    const CoordinateKind& b = *find_coordinate_kind(second);
    std::vector<double> shares;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      shares.push_back(static_cast<double>(i) / static_cast<double>(points_.size() - 1));
    }
    const Made mixed = prepare_mixed(cage_, both(a, b), points_, shares);
    const Made of_a = prepare_coordinates(cage_, CoordinateSettings(a));
    const Made of_b = prepare_coordinates(cage_, CoordinateSettings(b));
    ASSERT_TRUE(mixed && of_a && of_b) << first << ' ' << second;
    const auto rule = coordinate_rule(cage_, both(a, b));
    ASSERT_TRUE(rule);
    EXPECT_EQ((*rule)->columns(), (*mixed)->columns());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vec3 expected = (1 - shares[i]) * moved(**of_a, points_[i], pose_) +
                            shares[i] * moved(**of_b, points_[i], pose_);
      EXPECT_LT((moved(**mixed, points_[i], pose_) - expected).norm(), 1e-14);
      EXPECT_EQ(moved(**mixed, points_[i], cage_.positions), points_[i]);
      if (const std::vector<Vec3> from = (*rule)->reproduced_from(); !from.empty()) {
        EXPECT_LT((reproduced(solve(**mixed, points_[i]).weights, from) - points_[i]).norm(),
                  1e-12);
      }
    }
  }
}

TEST_F(Mixed, HasTheColumnsOfTheVerticesOnceWhereThereAreNoOthers) {
  const std::vector<double> shares(points_.size(), 0.3);
  const auto columns = [&](const char* first, const char* second) {
    return (*prepare_mixed(cage_, both(*find_coordinate_kind(first), *find_coordinate_kind(second)),
                           points_, shares))
        ->columns();
  };
  EXPECT_EQ(columns("mean_value", "maximum_entropy"), 8U);
  EXPECT_EQ(columns("mean_value", "green"), 8U + 8U + 24U);
}

TEST_F(Mixed, KeepsPointsAtOnePlaceTogether) {
  std::vector<Vec3> points = points_;
  points.push_back(points[3]);
  std::vector<double> shares(points.size(), 0.0);
  shares.back() = 1; // the same place as number 3, of share 0
  const Made mixed = prepare_mixed(
      cage_, both(*find_coordinate_kind("mean_value"), *find_coordinate_kind("green")), points,
      shares);
  const Made half = prepare_mixed(
      cage_, both(*find_coordinate_kind("mean_value"), *find_coordinate_kind("green")),
      std::span(points).last(1), std::vector<double>{0.5});
  ASSERT_TRUE(mixed && half);
  EXPECT_EQ(solve(**mixed, points[3]).weights, solve(**half, points[3]).weights);
}

TEST_F(Mixed, DoesNotAskAKindOfWhichThereIsNothing) {
  const Vec3 outside(0.5, 0.5, 3); // where harmonic coordinates and their like are none
  const CoordinateSettings settings =
      both(*find_coordinate_kind("mean_value"), *find_coordinate_kind("maximum_entropy"));
  const auto counts = [&](double share) {
    const Made mixed = prepare_mixed(cage_, settings, std::span(&outside, 1), std::vector{share});
    return solve(**mixed, outside);
  };
  EXPECT_EQ(counts(0).report.outside, 0);
  EXPECT_GT(largest(counts(0).weights), 0);
  EXPECT_EQ(counts(0.1).report.outside, 1);
  EXPECT_EQ(largest(counts(0.1).weights), 0);
}

TEST_F(Mixed, KnowsItsPointsAlone) {
  const std::vector<double> shares(points_.size(), 0.3);
  const Made mixed = prepare_mixed(
      cage_, both(*find_coordinate_kind("mean_value"), *find_coordinate_kind("green")), points_,
      shares);
  const Solved other = solve(**mixed, points_[0] + Vec3(1e-9, 0, 0));
  EXPECT_EQ(other.report.undefined, 1);
  EXPECT_EQ(largest(other.weights), 0);
}

TEST_F(Mixed, RefusesRulesThatDivide) {
  CoordinateSettings settings =
      both(*find_coordinate_kind("somigliana"), *find_coordinate_kind("green"));
  ASSERT_TRUE(settings.set("local", "0.5"));
  const auto rule = coordinate_rule(cage_, settings);
  ASSERT_FALSE(rule);
  EXPECT_EQ(rule.error().code, ErrorCode::invalid_option);
}

TEST_F(Mixed, NeedsShares) {
  const auto made = prepare_coordinates(
      cage_, both(*find_coordinate_kind("mean_value"), *find_coordinate_kind("green")));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::invalid_option);
}

TEST(MixedSettings, AreReadBackFromTheirNameAndText) {
  CoordinateSettings settings =
      both(*find_coordinate_kind("harmonic"), *find_coordinate_kind("somigliana"));
  EXPECT_EQ(settings.name(), "harmonic+somigliana");
  ASSERT_TRUE(settings.set("outside", "rest"));      // of both
  ASSERT_TRUE(settings.set("poisson-ratio", "0.4")); // of the second
  ASSERT_TRUE(settings.set("accuracy", "0.01"));     // of the first
  EXPECT_FALSE(settings.set("closeness", "1"));      // of neither
  const auto again = CoordinateSettings::parse(settings.name(), settings.text());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->name(), settings.name());
  EXPECT_EQ(again->text(), settings.text());
  EXPECT_TRUE(again->same_weights(settings));
  EXPECT_FALSE(CoordinateSettings(*find_coordinate_kind("harmonic")).same_weights(settings));
  EXPECT_FALSE(CoordinateSettings::of("harmonic+teapot"));
}

} // namespace
} // namespace cagewright
