#include "generate/density.h"

#include "io/read_vertex_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cagewright::cli {
namespace {

constexpr double strongest = 16;   // pure paint: edges a quarter as long, or four times
constexpr double least_part = 100; // of the largest weight counts as one: see ImproveOptions

double paint(const std::array<float, 4>& color) {
  const auto [r, g, b, alpha] = color;
  const double red = std::max(0.0F, r - std::max(g, b));
  const double blue = std::max(0.0F, b - std::max(r, g));
  return red - blue;
}

Result<std::vector<double>> density_of_colors(const PolygonMesh& model) {
  if (model.colors.empty()) {
    return Error{ErrorCode::unfit_model,
                 "--density colors: the model has no vertex colors; paint them, and export as PLY, "
                 "or as OBJ with colors"};
  }
  std::vector<double> density;
  density.reserve(model.colors.size());
  bool is_painted = false;
  for (const std::array<float, 4>& color : model.colors) {
    const double amount = paint(color);
    is_painted = is_painted || amount != 0;
    density.push_back(std::pow(strongest, amount));
  }
  if (!is_painted) {
    return Error{ErrorCode::unfit_model,
                 "--density colors: no vertex of the model is red (finer) or blue (coarser)"};
  }
  return density;
}

} // namespace

Result<std::vector<double>> density_of(const std::string& source, const PolygonMesh& model) {
  if (source == "colors") {
    return density_of_colors(model);
  }
  Result<std::vector<double>> weights = read_vertex_weights(source, model.positions.size());
  if (!weights) {
    return weights;
  }
  const double largest = *std::max_element(weights->begin(), weights->end());
  if (!(largest > 0)) {
    return Error{ErrorCode::unfit_model,
                 source + ": no number is above 0; write larger numbers where the cage is to be "
                          "finer"};
  }
  for (double& weight : *weights) {
    weight = std::max(weight, largest / least_part);
  }
  return weights;
}

} // namespace cagewright::cli
