/// \file
/// Where the user wants the cage finer, as ImproveOptions::density takes it.
#pragma once

#include <cagewright/core/result.h>

#include <array>
#include <span>
#include <vector>

namespace cagewright {

/// The density that vertex colors paint: 16^(red - blue), where red paint is max(0, R - max(G, B))
/// and blue paint max(0, B - max(R, G)), from 0 to 1 each. White, grey and black are even; on red
/// the edges of the cage get a quarter as long, on blue four times as long.
///
/// \param colors  V sRGB colors with opacity, of the model's vertices
/// \returns V weights above 0
/// Errors: unfit_model (no colors, or none of red or blue).
Result<std::vector<double>> painted_density(std::span<const std::array<float, 4>> colors);

/// The density of numbers that are not negative, as of a file: 0 stands for a hundredth of the
/// largest. Errors: unfit_model (no number above 0).
Result<std::vector<double>> density_of_weights(std::vector<double> weights);

} // namespace cagewright
