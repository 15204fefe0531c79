#include "improve/shave.h"

#include "core/parallel.h"
#include "improve/placement.h"
#include "improve/relax.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// The worst of all faces and vertices of a cage.
struct WorstShape {
  double quality = 1;
  double bend = 1;
  std::size_t valence = 0;
};

WorstShape worst_shape(const CageMesh& mesh) {
  WorstShape worst;
  for (Index f = 0; f < mesh.face_end(); ++f) {
    if (!mesh.has_face(f)) {
      continue;
    }
    const Corners at = corners_of(mesh, f);
    worst.quality = std::min(worst.quality, shape_quality(at));
    const Triangle& t = mesh.face(f);
    for (int i = 0; i < 3; ++i) {
      worst.bend = std::min(worst.bend, bend(at, corners_across(mesh, at, t[(i + 1) % 3], t[i])));
      worst.valence = std::max(worst.valence, mesh.valence(t[i]));
    }
  }
  return worst;
}

/// A way to go about it. What fails in one way often goes in another.
struct Way {
  bool to_nearest = false; ///< collapse the edge that ends nearest to the model, not the cheapest
  int steps = 0;           ///< of relaxation after every collapse
};

class Shaver {
public:
  Shaver(WorkingCage& cage, const Guard& guard, const Objective& objective, Index tip,
         std::size_t most_valence, const ShapeLimits& limits, const Way& way)
      : cage_(cage), guard_(guard), objective_(objective), tip_(tip), way_(way),
        far_(distance(tip)) {
    const WorstShape before = worst_shape(cage.mesh);
    limits_ = {std::min(limits.least_quality, before.quality),
               std::min(limits.sharpest_bend, before.bend), std::max(most_valence, before.valence)};
  }

  /// \returns whether all that is left is near, and well shaped
  bool run() {
    constexpr int most = 12;
    for (int i = 0; i < most; ++i) {
      const std::optional<Candidate> best = best_collapse();
      if (!best) {
        return false;
      }
      cage_.apply(best->patch);
      std::vector<Index> movable = cage_.mesh.neighbors(best->patch.vertex);
      movable.push_back(best->patch.vertex);
      relax(cage_, guard_, objective_, {.steps = way_.steps, .movable = movable});
      tip_ = farthest_of(movable);
      if (is_done()) {
        return true;
      }
    }
    return false;
  }

private:
  struct Candidate {
    Patch patch;
    double cost = 0; // the least is the best
  };

  [[nodiscard]] bool is_done() const {
    constexpr double nearer = 0.5;
    if (distance(tip_) > nearer * far_) {
      return false;
    }
    const WorstShape now = worst_shape(cage_.mesh);
    return now.quality >= limits_.quality && now.bend >= limits_.bend &&
           now.valence <= limits_.valence;
  }

  [[nodiscard]] double distance(Index v) const {
    return objective_.nearest(cage_.mesh.position(v)).distance;
  }

  [[nodiscard]] Index farthest_of(const std::vector<Index>& vertices) const {
    return *std::max_element(vertices.begin(), vertices.end(),
                             [&](Index a, Index b) { return distance(a) < distance(b); });
  }

  [[nodiscard]] std::optional<Candidate> best_collapse() const {
    const std::vector<Index> ends = cage_.mesh.neighbors(tip_);
    const std::vector<double> values = objective_.face_values(cage_.mesh);
    std::vector<std::optional<Candidate>> all(ends.size());
    parallel_for(0, ends.size(), 1, [&](std::size_t i) { all[i] = collapse_to(ends[i], values); });
    std::optional<Candidate> best;
    for (std::optional<Candidate>& candidate : all) {
      if (candidate && (!best || candidate->cost < best->cost)) {
        best = std::move(candidate);
      }
    }
    return best;
  }

  /// At the best place, or at the end of the edge: under a fin there is some of the model above the
  /// fin's lower side, and no place is found. A tip on a half's plane must stay in it.
  [[nodiscard]] std::optional<Candidate> collapse_to(Index end,
                                                     const std::vector<double>& values) const {
    std::optional<Patch> patch = cage_.mesh.collapse(tip_, end);
    if (!patch) {
      return std::nullopt;
    }
    std::optional<Candidate> best;
    for (const std::optional<Vec3>& place :
         {place_clear_of_model(guard_, objective_, cage_.mesh, *patch),
          std::optional<Vec3>(cage_.mesh.position(end))}) {
      if (!place || (patch->on_plane && place->x() != 0)) {
        continue;
      }
      patch->position = *place;
      const double cost = objective_.change(cage_.mesh, values, *patch);
      if ((!best || cost < best->cost) && is_valid(*patch)) {
        best = Candidate{*patch, cost};
      }
    }
    if (best && way_.to_nearest) {
      best->cost = distance(end);
    }
    return best;
  }

  [[nodiscard]] bool is_valid(const Patch& patch) const {
    return objective_.nearest(patch.position).distance <= far_ &&
           !guard_.too_near(cage_.mesh, patch) && !guard_.crosses(cage_.mesh, cage_.boxes, patch) &&
           !guard_.loses_a_part(cage_.mesh, patch) && !objective_.widens_gap(cage_.mesh, patch);
  }

  WorkingCage& cage_;
  const Guard& guard_;
  const Objective& objective_;
  Index tip_;
  Way way_;
  double far_;
  WorstShape limits_;
};

} // namespace

bool shave_tip(WorkingCage& cage, const Guard& guard, const Objective& objective, Index tip,
               std::size_t most_valence, const ShapeLimits& limits) {
  for (const Way way : {Way{false, 4}, Way{true, 4}, Way{false, 2}, Way{true, 0}}) {
    WorkingCage shaved = cage;
    if (Shaver(shaved, guard, objective, tip, most_valence, limits, way).run()) {
      shaved.reach = cage.reach;
      cage = std::move(shaved);
      return true;
    }
  }
  return false;
}

} // namespace cagewright
