#include "quads/settle_shapes.h"

#include <algorithm>

namespace cagewright {
namespace {

constexpr double thin = 0.152; // 2 r / R

} // namespace

double thin_share(const QuadCage& cage) {
  const std::vector<Vec3>& x = cage.positions();
  std::size_t count = 0;
  std::size_t faces = 0;
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (cage.has_face(f)) {
      const FaceParts parts(cage.face(f), FaceParts::Of::all);
      ++faces;
      count += std::any_of(parts.begin(), parts.end(), [&](const Triangle& t) {
        return shape_quality({x[t[0]], x[t[1]], x[t[2]]}) < thin;
      });
    }
  }
  return faces > 0 ? static_cast<double>(count) / static_cast<double>(faces) : 0;
}

void settle_shapes(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                   const RelaxQuadsOptions& options, const Progress& progress) {
  constexpr double enough = 0.05; // of the faces may be thin
  constexpr int attempts = 7;
  constexpr double dearer = 3;
  RelaxQuadsOptions rounder = options;
  rounder.steps = 4;
  rounder.first_step = std::min(options.first_step, 0.02);
  rounder.free_sine = 0.64; // corners of 140 degrees
  rounder.slender = 1 / dearer;
  rounder.free_defect = 1.5;      // rectangles four times as long as wide
  constexpr double settled = 0.7; // of the time
  int done = 0;
  for (; done < attempts && thin_share(cage) > enough && !progress.cancelled(); ++done) {
    rounder.corner *= dearer;
    rounder.slender *= dearer;
    relax_quads(cage, guard, objective, rounder,
                progress.part(settled * done / attempts, settled * (done + 1) / attempts));
  }
  if (done == 0) {
    return;
  }
  // What that has cost in tightness is won back where no face becomes thin.
  QuadLimits limits = guard.limits();
  limits.min_quality = std::max(limits.min_quality, thin);
  RelaxQuadsOptions tight = options;
  tight.steps = 8;
  tight.first_step = rounder.first_step;
  const QuadGuard round(guard.model(), guard.clearance(), limits);
  relax_quads(cage, round, objective, tight, progress.part(settled, 1));
}

} // namespace cagewright
