#include "quads/settle_shapes.h"

#include "mesh/shape_limits.h"
#include "quads/quad_merit.h"

#include <algorithm>
#include <utility>

namespace cagewright {
namespace {

constexpr double settled_thin = 1.013 * shape_limits::thin; // 2 r / R: with a little to spare

} // namespace

double thin_share(const QuadCage& cage) {
  const std::vector<Vec3>& x = cage.positions();
  std::ptrdiff_t count = 0;
  std::size_t triangles = 0;
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (cage.has_face(f)) {
      const FaceParts parts(along_shorter_diagonal(x, cage.face(f)), FaceParts::Of::all);
      const int written = std::min(2, parts.count);
      triangles += static_cast<std::size_t>(written);
      count += std::count_if(parts.begin(), parts.begin() + written, [&](const Triangle& t) {
        return shape_quality({x[t[0]], x[t[1]], x[t[2]]}) < settled_thin;
      });
    }
  }
  return triangles > 0 ? static_cast<double>(count) / static_cast<double>(triangles) : 0;
}

void settle_shapes(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress) {
  constexpr int attempts = 7;
  constexpr double dearer = 3;
  RelaxQuadsOptions rounder = options;
  rounder.steps = 4;
  rounder.first_step = std::min(options.first_step, 0.02);
  rounder.free_sine = 0.64; // corners of 140 degrees
  rounder.slender = 1 / dearer;
  rounder.free_defect = 1.5;      // rectangles four times as long as wide
  constexpr double settled = 0.7; // of the time
  const auto tightness = [&](QuadCage other) {
    RelaxQuadsOptions none = options;
    none.steps = 0;
    return relax_quads(other, guard, objective, none);
  };
  const auto cost = [&](const QuadCage& other) {
    return tightness(other) * dearer_by_thin(thin_share(other));
  };
  if (thin_share(cage) <= shape_limits::few_thin) {
    return;
  }
  const double before = cost(cage);
  constexpr double won_back = 1.3; // times as tight, at most, as where it stops
  QuadCage rounded = cage;
  for (int done = 0; done < attempts && thin_share(rounded) > shape_limits::few_thin &&
                     tightness(rounded) < won_back * before && !progress.cancelled();
       ++done) {
    rounder.corner *= dearer;
    rounder.slender *= dearer;
    relax_quads(rounded, guard, objective, rounder,
                progress.part(settled * done / attempts, settled * (done + 1) / attempts));
  }
  // What that has cost in tightness is won back where no face becomes thin.
  QuadLimits limits = guard.limits();
  limits.min_quality = std::max(limits.min_quality, settled_thin);
  RelaxQuadsOptions tight = options;
  tight.steps = 8;
  tight.first_step = rounder.first_step;
  const QuadGuard round(guard.model(), guard.clearance(), limits);
  relax_quads(rounded, round, objective, tight, progress.part(settled, 1));
  if (cost(rounded) < before) {
    cage = std::move(rounded);
  }
}

} // namespace cagewright
