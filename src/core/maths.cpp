#include "core/maths.h"

#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

// Each function takes its argument to a short interval exactly and sums the Taylor series there:
// the intervals are so short that its terms stop to count soon. Where one double is not enough, two
// are: a value and what it lacks.

static_assert(FLT_EVAL_METHOD == 0, "doubles must be rounded to double: with -msse2 -mfpmath=sse");

namespace cagewright::maths {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// high + low, low being less than the last place of high.
struct Two {
  double high;
  double low;
};

// Exactly a + b (Knuth).
Two sum(double a, double b) {
  const double high = a + b;
  const double of_b = high - a;
  return {high, (a - (high - of_b)) + (b - of_b)};
}

// Exactly a * b (Dekker), for factors up to 1e150.
Two product(double a, double b) {
  constexpr double halfway = 0x1p27 + 1;
  const auto upper_half = [](double x) {
    const double shifted = halfway * x;
    return shifted - (shifted - x);
  };
  const double a1 = upper_half(a);
  const double a2 = a - a1;
  const double b1 = upper_half(b);
  const double b2 = b - b1;
  const double high = a * b;
  return {high, ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2};
}

// The nearest whole number, for |x| < 2^51: the sum has no bits for fractions.
double nearest(double x) {
  constexpr double shift = 0x1.8p52;
  return (x + shift) - shift;
}

// x 2^k; two factors, because k may be beyond the exponents of double.
double scaled(double x, int k) {
  const auto power = [](int of_two) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + of_two) << 52U);
  };
  return x * power(k / 2) * power(k - k / 2);
}

/// c[0] + c[1] z + c[2] z^2 + ...; pairs first, so that one multiplication need not wait for all
/// others.
template <std::size_t n> double series(const std::array<double, n>& c, double z) {
  static_assert(n % 2 == 0);
  const double zz = z * z;
  double value = c[n - 2] + c[n - 1] * z;
  for (std::size_t i = n - 2; i > 0; i -= 2) {
    value = value * zz + (c[i - 2] + c[i - 1] * z);
  }
  return value;
}

/// 1 / from!, -+ 1 / (from + step)!, ...: terms of the exponential series, all of them or every
/// second with signs alternating. (Factorials up to 22! are exact.)
template <std::size_t n> constexpr std::array<double, n> over_factorials(int from, int step) {
  const auto factorial = [](int k) {
    double value = 1;
    for (int i = 2; i <= k; ++i) {
      value *= i;
    }
    return value;
  };
  std::array<double, n> terms{};
  for (int t = 0; t < static_cast<int>(n); ++t) {
    terms[t] = (step == 2 && t % 2 == 1 ? -1 : 1) / factorial(from + step * t);
  }
  return terms;
}

constexpr double ln2_high = 0x1.62e42fefa2p-1; // 40 bits: times an exponent it is exact
constexpr double ln2_low = 0x1.9ef35793c7673p-41;

/// log(x) for finite x > 0, with some ten bits more than a double has.
///
/// x = 2^k m with m in [sqrt(1/2), sqrt(2)), s = (m - 1) / (m + 1), |s| < 0.172, and
/// log m = 2 artanh s = 2 s + 2/3 s^3 + 2/5 s^5 + ...
Two log_of(double x) {
  int k = 0;
  if (x < DBL_MIN) {
    x *= 0x1p54;
    k = -54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  k += static_cast<int>(bits >> 52U) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > std::numbers::sqrt2) {
    m /= 2;
    ++k;
  }
  static constexpr std::array<double, 10> artanh{2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                                                 2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
  const Two below = sum(m, 1);
  const double s = (m - 1) / below.high;
  const Two back = product(s, below.high);
  const double s_low = (((m - 1) - back.high) - back.low - s * below.low) / below.high;
  const double rest = s * (s * s) * series(artanh, s * s);
  const Two high = sum(k * ln2_high, 2 * s);
  const double low = high.low + (2 * s_low + rest + k * ln2_low);
  const double value = high.high + low;
  return {value, low - (value - high.high)};
}

/// e^(x.high + x.low) by e^(k log 2 + r) = 2^k e^r, |r| < 0.347.
double exp_of(const Two& x) {
  if (!(x.high < 709.8)) {
    return x.high > 0 ? infinity : x.high; // NaN
  }
  if (x.high < -745.2) {
    return 0;
  }
  static constexpr auto terms = over_factorials<12>(2, 1);
  const double k = nearest(x.high * (1 / std::numbers::ln2));
  const double r = x.high - k * ln2_high;
  const double low = x.low - k * ln2_low;
  const Two at = sum(r, low);
  const double z = at.high;
  const double rest = z * z * series(terms, z) + (at.low + z * at.low);
  return scaled(1 + (z + rest), static_cast<int>(k));
}

struct Quarter {
  Two angle; ///< in [-pi/4, pi/4], give or take a rounding
  int count; ///< quarter turns before it
};

Quarter quarter_turns(double x) {
  // Three parts of pi / 2, of which the first two have 33 bits: times a count they are exact.
  constexpr double part[3] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
  const double k = nearest(x * (2 / std::numbers::pi));
  const Two first = sum(x - k * part[0], -(k * part[1]));
  const Two both = sum(first.high, first.low - k * part[2]);
  return {both, static_cast<int>(k) & 3};
}

double sin_near_zero(const Two& x) {
  static constexpr auto terms = over_factorials<8>(3, 2);
  const double z = x.high * x.high;
  return x.high - (x.high * z * series(terms, z) - x.low * (1 - z / 2));
}

double cos_near_zero(const Two& x) {
  static constexpr auto terms = over_factorials<8>(4, 2);
  const double z = x.high * x.high;
  const double value = 1 - z / 2;
  return value + (((1 - value) - z / 2) + (z * z * series(terms, z) - x.high * x.low));
}

/// The sine `turns` quarter turns on.
double sin_after(double x, int turns) {
  constexpr double most = 1e5;
  if (!(std::abs(x) <= most)) {
    return not_a_number;
  }
  const Quarter at = quarter_turns(x);
  switch ((at.count + turns) & 3) {
  case 0:
    return sin_near_zero(at.angle);
  case 1:
    return cos_near_zero(at.angle);
  case 2:
    return -sin_near_zero(at.angle);
  default:
    return -cos_near_zero(at.angle);
  }
}

/// atan(a / b) for 0 <= a <= b, b > 0, both finite, as a value and what it lacks.
///
/// From the nearest eighth c it is atan t away, t = (a - c b) / (b + c a), |t| < 0.063.
Two atan_of(double a, double b) {
  static constexpr Two eighths[9] = {{0, 0},
                                     {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                     {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                     {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                     {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                     {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                     {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                     {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  static constexpr std::array<double, 6> terms{-1.0 / 3, 1.0 / 5,   -1.0 / 7,
                                               1.0 / 9,  -1.0 / 11, 1.0 / 13};
  const double nearest_eighth = nearest(8 * a / b);
  const double c = nearest_eighth / 8;
  const double t = (a - c * b) / (b + c * a);
  const Two& from = eighths[static_cast<int>(nearest_eighth)];
  const double z = t * t;
  const Two both = sum(from.high, t);
  return {both.high, both.low + (t * z * series(terms, z) + from.low)};
}

} // namespace

double exp(double x) {
  return exp_of({x, 0});
}

double log(double x) {
  if (!(x > 0 && x < infinity)) {
    return x == 0 ? -infinity : x > 0 ? infinity : not_a_number;
  }
  return log_of(x).high;
}

double pow(double x, double y) {
  if (y == 0 || x == 1) {
    return 1;
  }
  if (!(x > 0 && x < infinity) || !(std::abs(y) < 1e150)) {
    if (!(x >= 0) || std::isnan(y)) {
      return not_a_number;
    }
    return (x > 1) == (y > 0) ? infinity : 0;
  }
  const Two logarithm = log_of(x);
  const Two power = product(y, logarithm.high);
  return exp_of({power.high, power.low + y * logarithm.low});
}

double sin(double x) {
  return sin_after(x, 0);
}

double cos(double x) {
  return sin_after(x, 1);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) {
    return not_a_number;
  }
  double a = std::abs(y);
  double b = std::abs(x);
  if (a == infinity || b == infinity) { // as if along an axis, or between two
    a = a == infinity ? 1 : 0;
    b = b == infinity ? 1 : 0;
  }
  const bool steep = a > b;
  if (steep) {
    std::swap(a, b);
  }
  if (b > 0x1p1000) { // b + c a might overflow
    a *= 0x1p-100;
    b *= 0x1p-100;
  }
  Two angle = b > 0 ? atan_of(a, b) : Two{0, 0};
  constexpr Two half_turn{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
  if (steep) {
    const Two rest = sum(half_turn.high / 2, -angle.high);
    angle = {rest.high, rest.low + (half_turn.low / 2 - angle.low)};
  }
  if (std::signbit(x)) {
    const Two rest = sum(half_turn.high, -angle.high);
    angle = {rest.high, rest.low + (half_turn.low - angle.low)};
  }
  return std::copysign(angle.high + angle.low, y);
}

} // namespace cagewright::maths
