#include "cage/best_of.h"
#include "cage/triangle_stage.h"

#include <array>
#include <utility>

namespace cagewright {

Result<Triangles> improve_well_shaped(const Ground& ground, TriangleView start,
                                      const ImproveOptions& budget, const Progress& progress) {
  const auto merit = [](const Improved& made) {
    return Merit(made.report.reached, TriangleView(made.cage));
  };
  const auto cost_of = [&](const Improved& made) { return merit(made).cost(); };
  BestOf<Improved, decltype(cost_of)> tries(cost_of);
  constexpr std::array<double, 3> dearer = {1, 2, 4};
  double done = 0;
  for (const double factor : dearer) {
    if (factor > 1 && (!tries.best().report.reached || !ground.runs().are_left() ||
                       merit(tries.best()).is_well_shaped())) {
      break;
    }
    ImproveOptions rounder = budget;
    rounder.shape *= factor;
    const double then = factor > 1 ? (done + 1) / 2 : 0.8; // hardly ever is there another try
    if (!tries.add(ground.improved(start, rounder, progress.part(done, then)))) {
      break;
    }
    done = then;
  }
  Result<Improved> best = tries.taken();
  return best ? Result<Triangles>(Triangles{std::move(*best), std::nullopt, std::nullopt})
              : best.error();
}

} // namespace cagewright
