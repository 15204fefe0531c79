#include "cage/part_options.h"

#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>

namespace cagewright {

PartOptions options_for(const ModelPart& part, double whole, const BudgetCageOptions& options) {
  PartOptions result{options, {}};
  BudgetCageOptions& own = result.options;
  const double factor = whole / diagonal(part.mesh.positions);
  own.boxes.boxes.pieces = Pieces::together;
  own.improve.clearance *= factor;
  own.max_gap *= factor;
  own.closing = std::min(0.5, own.closing * factor);
  if (own.resolution > 0) {
    own.resolution = std::max(8, static_cast<int>(std::lround(own.resolution / factor)));
  }
  if (!options.improve.density.empty()) {
    for (const Index v : part.vertices) {
      result.density.push_back(options.improve.density[v]);
    }
    own.improve.density = result.density;
  }
  return result;
}

void restate(BudgetCage& cage, double factor) {
  cage.clearance *= factor;
  cage.clearance_asked *= factor;
  cage.report.objective *= factor * factor * factor;
  if (cage.gap) {
    *cage.gap *= factor;
  }
}

} // namespace cagewright
