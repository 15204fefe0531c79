#include <cagewright/render/palette.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

double to_srgb(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

/// Oklab's lightness, chroma and hue (turns) as sRGB, clipped to what a screen shows.
Rgb from_lch(double lightness, double chroma, double turns) {
  const double angle = 2 * std::numbers::pi * turns;
  const double a = chroma * std::cos(angle);
  const double b = chroma * std::sin(angle);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {static_cast<float>(to_srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
          static_cast<float>(to_srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
          static_cast<float>(to_srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))};
}

} // namespace

Rgb to_linear(const Rgb& srgb) {
  Rgb linear;
  for (std::size_t i = 0; i < 3; ++i) {
    const float c = srgb[i];
    linear[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
  }
  return linear;
}

Rgb group_color(std::size_t n) {
  // Steps of the golden ratio: any number of groups in a row is spread evenly over the hues.
  const double turns = 0.7 + 0.6180339887 * static_cast<double>(n % 4096);
  return from_lch(n % 2 == 0 ? 0.66 : 0.74, 0.15, turns - std::floor(turns));
}

Rgb scale_color(double value) {
  const double t = std::clamp(value, 0.0, 1.0);
  return from_lch(0.32 + 0.56 * t, 0.11 + 0.05 * t, 0.80 - 0.50 * t);
}

} // namespace cagewright
