#include "cage/budget_start.h"

#include "envelope/envelope.h"

#include <utility>

namespace cagewright {

int vertices_of(const ImproveOptions& budget) {
  return budget.vertices > 0 ? budget.vertices : budget.faces > 0 ? budget.faces / 2 + 2 : 0;
}

Result<TriangleMesh> start_from_envelope(TriangleView model, const BudgetCageOptions& options,
                                         CageExtent extent, double diagonal, BudgetCage& made,
                                         const Progress& progress) {
  const ImproveOptions& budget = options.improve;
  EnvelopeOptions start;
  start.resolution = options.resolution;
  start.closing = options.closing;
  start.clearance = budget.clearance;
  for (const int vertices : {vertices_of(budget), options.envelope_vertices}) {
    start.vertices = vertices > 0 ? vertices : start.vertices;
  }
  start.half = extent == CageExtent::half;
  start.diagonal = diagonal;
  Result<Envelope> envelope_made = envelope(model, start, progress);
  if (!envelope_made) {
    return envelope_made.error();
  }
  made.resolution = envelope_made->resolution;
  made.genus = envelope_made->genus;
  made.bridges = envelope_made->bridges;
  made.clearance = budget.clearance;
  return std::move(envelope_made->mesh);
}

} // namespace cagewright
