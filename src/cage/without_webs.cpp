#include "cage/best_of.h"
#include "cage/triangle_stage.h"

#include <utility>

namespace cagewright {

Result<Triangles> improve_without_webs(const Ground& ground, ImproveOptions budget,
                                       const Improver& improver, const Progress& progress) {
  const auto webbing_of = [&](const Triangles& made) {
    return ground.between().share_inside(ground.with_image(made.improved.cage));
  };
  const auto cost_of = [&](const Triangles& made) {
    const ImproveReport& report = made.improved.report;
    return Cost{!report.reached, report.objective * dearer_by(webbing_of(made), 0, 0), 0};
  };
  constexpr double first = 0.8; // of the time
  BestOf<Triangles, decltype(cost_of)> tries(cost_of);
  if (!tries.add(improver(budget, progress.part(0, first))) ||
      !tries.best().improved.report.reached || !ground.runs().are_left() ||
      webbing_of(tries.best()) < webbed) {
    return tries.taken();
  }
  budget.between = &ground.between_on_side();
  tries.add(improver(budget, progress.part(first, 1)));
  return tries.taken();
}

} // namespace cagewright
