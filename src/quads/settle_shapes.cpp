#include "quads/settle_shapes.h"

#include <algorithm>

namespace cagewright {

double thin_share(const QuadCage& cage) {
  constexpr double thin = 0.16;
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
  constexpr int attempts = 3;
  constexpr double dearer = 3;
  RelaxQuadsOptions rounder = options;
  rounder.steps = 4;
  rounder.first_step = std::min(options.first_step, 0.02);
  rounder.corner *= dearer;
  rounder.free_sine = 0.64; // corners of 140 degrees
  rounder.slender = 1;
  rounder.free_defect = 1.5; // rectangles four times as long as wide
  for (int i = 0; i < attempts && thin_share(cage) > enough && !progress.cancelled(); ++i) {
    relax_quads(cage, guard, objective, rounder,
                progress.part(static_cast<double>(i) / attempts, (i + 1.0) / attempts));
    rounder.slender *= dearer;
  }
}

} // namespace cagewright
