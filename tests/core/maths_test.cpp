#include "core/maths.h"

#include "core/random.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace cagewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How many places of the last digit of `exact` lie between the two.
double ulps(double value, long double exact) {
  const double nearest = std::abs(static_cast<double>(exact));
  const double place = std::nextafter(nearest, infinity) - nearest;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / place;
}

class Spread {
public:
  double in(double from, double to) { return random_.uniform(from, to); }
  double powers_of_ten(double from, double to) { return std::pow(10.0, in(from, to)); }

private:
  Random random_{7};
};

constexpr int count = 100'000;

TEST(Maths, ExponentialsAreWithinAnUlp) {
  Spread spread;
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double x = i % 2 == 0 ? spread.in(-2, 2) : spread.in(-700, 700);
    worst = std::max(worst, ulps(maths::exp(x), std::exp(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 1);
}

TEST(Maths, LogarithmsAreWithinAnUlp) {
  Spread spread;
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double x = i % 2 == 0 ? spread.in(0.5, 2) : spread.powers_of_ten(-320, 308);
    worst = std::max(worst, ulps(maths::log(x), std::log(static_cast<long double>(x))));
    const double close = 1 + spread.in(-1e-9, 1e-9);
    worst = std::max(worst, ulps(maths::log(close), std::log(static_cast<long double>(close))));
  }
  EXPECT_LT(worst, 1);
}

TEST(Maths, PowersAreWithinAnUlpWhereCagesNeedThem) {
  Spread spread;
  double worst = 0;
  double worst_far = 0;
  for (int i = 0; i < count; ++i) {
    const double x = spread.powers_of_ten(-8, 8);
    const double y = spread.in(-30, 30);
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (exact > 1e-6L && exact < 1e6L) {
      worst = std::max(worst, ulps(maths::pow(x, y), exact));
    } else if (exact > 1e-300L && exact < 1e300L) {
      worst_far = std::max(worst_far, ulps(maths::pow(x, y), exact));
    }
  }
  EXPECT_LT(worst, 1);
  EXPECT_LT(worst_far, 20);
}

TEST(Maths, SinesAndCosinesAreWithinAnUlp) {
  Spread spread;
  double worst = 0;
  double worst_small = 0;
  for (int i = 0; i < count; ++i) {
    const double x = i % 2 == 0 ? spread.in(-7, 7) : spread.in(-1e5, 1e5);
    const auto compare = [&](double value, long double exact) {
      if (std::abs(exact) > 1e-3L) {
        worst = std::max(worst, ulps(value, exact));
      } else {
        worst_small = std::max(worst_small, static_cast<double>(std::abs(value - exact)));
      }
    };
    compare(maths::sin(x), std::sin(static_cast<long double>(x)));
    compare(maths::cos(x), std::cos(static_cast<long double>(x)));
  }
  for (int i = 1; i < 1000; ++i) {
    const double x = i * std::numbers::pi; // all but zero
    EXPECT_NEAR(maths::sin(x), static_cast<double>(std::sin(static_cast<long double>(x))), 1e-18);
  }
  EXPECT_LT(worst, 1);
  EXPECT_LT(worst_small, 1e-16);
}

TEST(Maths, AnglesAreWithinTwoUlp) {
  Spread spread;
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double size = i % 2 == 0 ? 1 : spread.powers_of_ten(-300, 300);
    const double y = size * spread.in(-1, 1);
    const double x = size * spread.in(-1, 1) * (i % 3 == 0 ? spread.powers_of_ten(-7, 7) : 1);
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst, ulps(maths::atan2(y, x), exact));
  }
  EXPECT_LT(worst, 2);
}

TEST(Maths, AnglesOfTheAxesAndAtTheEndsAreThoseOfTheStandard) {
  constexpr double values[] = {0.0, -0.0, 1.0, -1.0, infinity, -infinity, 1e308, -1e308, 5e-324};
  for (const double y : values) {
    for (const double x : values) {
      EXPECT_DOUBLE_EQ(maths::atan2(y, x), std::atan2(y, x)) << y << ' ' << x;
      EXPECT_EQ(std::signbit(maths::atan2(y, x)), std::signbit(std::atan2(y, x))) << y << ' ' << x;
    }
  }
}

TEST(Maths, EndsOfTheRangesAreThoseOfTheStandard) {
  EXPECT_EQ(maths::exp(0), 1);
  EXPECT_EQ(maths::exp(710), infinity);
  EXPECT_EQ(maths::exp(infinity), infinity);
  EXPECT_EQ(maths::exp(-746), 0);
  EXPECT_EQ(maths::exp(-infinity), 0);
  EXPECT_NEAR(maths::exp(-740), std::exp(-740.0), 5e-324);
  EXPECT_EQ(maths::log(1), 0);
  EXPECT_EQ(maths::log(0), -infinity);
  EXPECT_EQ(maths::log(infinity), infinity);
  EXPECT_TRUE(std::isnan(maths::log(-1)));
  EXPECT_EQ(maths::pow(0, 2.5), 0);
  EXPECT_EQ(maths::pow(0, -2.5), infinity);
  EXPECT_EQ(maths::pow(0, 0), 1);
  EXPECT_EQ(maths::pow(infinity, -1), 0);
  EXPECT_EQ(maths::pow(2, 10), 1024);
  EXPECT_EQ(maths::pow(2, 2000), infinity);
  EXPECT_EQ(maths::pow(2, -infinity), 0);
  EXPECT_EQ(maths::pow(0.5, -infinity), infinity);
  EXPECT_TRUE(std::isnan(maths::pow(-1, 2)));
  EXPECT_EQ(maths::sin(0), 0);
  EXPECT_EQ(maths::cos(0), 1);
  EXPECT_TRUE(std::isnan(maths::sin(infinity)));
}

} // namespace
} // namespace cagewright
