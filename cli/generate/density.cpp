#include "generate/density.h"

#include <cagewright/cage/density.h>
#include <cagewright/io/read_vertex_weights.h>

#include <utility>

namespace cagewright::cli {

Result<std::vector<double>> density_of(const std::string& source, const PolygonMesh& model) {
  const auto named = [](const std::string& name, Result<std::vector<double>> density) {
    return density ? density
                   : Result<std::vector<double>>(
                         Error{density.error().code, name + ": " + density.error().message});
  };
  if (source == "colors") {
    return named("--density colors", painted_density(model.colors));
  }
  Result<std::vector<double>> weights = read_vertex_weights(source, model.positions.size());
  return weights ? named(source, density_of_weights(std::move(*weights))) : weights;
}

} // namespace cagewright::cli
