#include "cage/part_options.h"

#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>

namespace cagewright {

PartOptions options_for(const ModelPart& part, double whole, const GenerateOptions& options) {
  PartOptions result{options, {}};
  GenerateOptions& own = result.options;
  const double factor = whole / diagonal(part.mesh.positions);
  own.pieces = Pieces::together;
  own.clearance *= factor;
  own.max_gap *= factor;
  own.closing = std::min(0.5, own.closing * factor);
  if (own.envelope_resolution > 0) {
    own.envelope_resolution =
        std::max(8, static_cast<int>(std::lround(own.envelope_resolution / factor)));
  }
  if (!options.density.empty()) {
    for (const Index v : part.vertices) {
      result.density.push_back(options.density[v]);
    }
    own.density = result.density;
  }
  return result;
}

void restate(GeneratedCage& cage, double factor) {
  cage.clearance *= factor;
  cage.objective *= factor * factor * factor;
  if (cage.gap) {
    *cage.gap *= factor;
  }
}

} // namespace cagewright
