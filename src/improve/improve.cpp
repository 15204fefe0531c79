#include "improve/improve.h"

#include "improve/relax.h"
#include "improve/simplify.h"
#include "mesh/measures.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace cagewright {

Result<Improved> improve(TriangleView start, TriangleView model, const ImproveOptions& options,
                         const Progress& progress) {
  if (start.triangles.empty()) {
    return Error{ErrorCode::invalid_cage, "the cage to start from has no faces"};
  }
  const ModelSurface surface(model);
  const Guard guard(surface, options.clearance * surface.diagonal);
  std::size_t target = 4;
  if (options.vertices > 0) {
    target = static_cast<std::size_t>(options.vertices);
  }
  ObjectiveWeights weights;
  weights.square = options.square;
  weights.shape = options.shape;
  weights.typical_area = surface_area(start) / (2.0 * static_cast<double>(target));
  const Objective objective(surface, weights);
  WorkingCage cage(start);
  const auto t0 = std::chrono::steady_clock::now();
  SimplifyOptions simple;
  simple.most_valence = static_cast<std::size_t>(options.most_valence);
  simple.placement = Placement::outside_patch;
  simple.vertices = 5 * target;
  simplify(cage, guard, objective, simple, progress);
  const auto t1 = std::chrono::steady_clock::now();
  simple.placement = Placement::clear_of_model;
  simple.vertices = target;
  simplify(cage, guard, objective, simple, progress);
  RelaxOptions rel;
  rel.steps = options.rounds;
  relax(cage, guard, objective, rel, progress);
  const auto t2 = std::chrono::steady_clock::now();
  Improved result;
  result.cage = cage.mesh.compact();
  result.report.simplify_seconds = std::chrono::duration<double>(t1 - t0).count();
  result.report.refine_seconds = std::chrono::duration<double>(t2 - t1).count();
  result.report.reached = cage.mesh.vertex_count() <= target;
  result.report.objective = objective.total(cage.mesh) / std::pow(surface.diagonal, 3);
  return result;
}

} // namespace cagewright
