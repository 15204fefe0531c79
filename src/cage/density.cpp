#include <cagewright/cage/density.h>

#include "core/maths.h"

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

constexpr double strongest = 16;   // pure paint: edges a quarter as long, or four times
constexpr double least_part = 100; // of the largest weight counts as one: see ImproveOptions

double paint(const std::array<float, 4>& color) {
  const auto [r, g, b, alpha] = color;
  const double red = std::max(0.0F, r - std::max(g, b));
  const double blue = std::max(0.0F, b - std::max(r, g));
  return red - blue;
}

} // namespace

Result<std::vector<double>> painted_density(std::span<const std::array<float, 4>> colors) {
  if (colors.empty()) {
    return Error{ErrorCode::unfit_model,
                 "the model has no vertex colors; paint them, and export as PLY, or as OBJ with "
                 "colors"};
  }
  std::vector<double> density;
  density.reserve(colors.size());
  bool is_painted = false;
  for (const std::array<float, 4>& color : colors) {
    const double amount = paint(color);
    is_painted = is_painted || amount != 0;
    density.push_back(maths::pow(strongest, amount));
  }
  if (!is_painted) {
    return Error{ErrorCode::unfit_model, "no vertex of the model is red (finer) or blue (coarser)"};
  }
  return density;
}

Result<std::vector<double>> density_of_weights(std::vector<double> weights) {
  const double largest = weights.empty() ? 0 : *std::max_element(weights.begin(), weights.end());
  if (!(largest > 0)) {
    return Error{ErrorCode::unfit_model,
                 "no number is above 0; write larger numbers where the cage is to be finer"};
  }
  for (double& weight : weights) {
    weight = std::max(weight, largest / least_part);
  }
  return weights;
}

} // namespace cagewright
