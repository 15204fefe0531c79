/// \file
/// Colours for pictures.
#pragma once

#include <array>
#include <cstddef>

namespace cagewright {

/// Red, green and blue in [0, 1], sRGB.
using Rgb = std::array<float, 3>;

/// The same colour in linear light, in which colours are added and averaged.
Rgb to_linear(const Rgb& srgb);

/// Colour of the n-th group: of equal lightness and strength, neighbours far apart in hue.
Rgb group_color(std::size_t n);

/// A colour for a quantity in [0, 1], from deep blue over green to yellow. Lightness rises
/// steadily, so that the picture also reads in grey. Values outside are taken as 0 or 1.
Rgb scale_color(double value);

} // namespace cagewright
