#include "cage/merit.h"
#include "cage/triangle_stage.h"

#include <array>
#include <utility>

namespace cagewright {

Result<Triangles> improve_well_shaped(const Ground& ground, TriangleView start,
                                      const ImproveOptions& budget, const Progress& progress) {
  const auto merit = [](const Improved& improved) {
    return Merit(improved.report.reached, TriangleView(improved.cage));
  };
  constexpr std::array<double, 2> dearer = {2, 4};
  double done = 0.8; // of the time: hardly ever is there another try
  Result<Improved> best = improve(start, ground.enclosed(), budget, progress.part(0, done));
  for (const double factor : dearer) {
    if (!best || !best->report.reached || merit(*best).is_well_shaped()) {
      break;
    }
    ImproveOptions rounder = budget;
    rounder.shape *= factor;
    const double then = (done + 1) / 2;
    Result<Improved> again = improve(start, ground.enclosed(), rounder, progress.part(done, then));
    done = then;
    if (!again || merit(*again) > merit(*best)) {
      best = std::move(again);
    }
  }
  if (!best) {
    return best.error();
  }
  return Triangles{std::move(*best), std::nullopt, std::nullopt};
}

} // namespace cagewright
