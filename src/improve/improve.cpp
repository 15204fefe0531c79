#include "improve/improve.h"

#include "core/maths.h"
#include "improve/refine.h"
#include "improve/relax.h"
#include "improve/shave.h"
#include "improve/simplify.h"
#include "mesh/shape_limits.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace cagewright {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Vertices that a cage like this one may have: a collapse takes a vertex and two faces, a split
// gives as many.
std::size_t vertex_budget(const CageMesh& start, const ImproveOptions& options) {
  const auto vertices = static_cast<std::ptrdiff_t>(start.vertex_count());
  const auto faces = static_cast<std::ptrdiff_t>((start.is_half() ? 2 : 1) * start.face_count());
  std::ptrdiff_t budget = options.vertices > 0 ? options.vertices : vertices;
  if (options.faces > 0) {
    const std::ptrdiff_t more = options.faces - faces;
    const std::ptrdiff_t splits = more >= 0 ? more / 2 : -((1 - more) / 2);
    budget = options.vertices > 0 ? std::min(budget, vertices + splits) : vertices + splits;
  }
  constexpr std::ptrdiff_t tetrahedron = 4;
  return static_cast<std::size_t>(std::max(budget, tetrahedron));
}

ObjectiveWeights weights_for(TriangleView start, TriangleView model, const ImproveOptions& options,
                             std::size_t budget) {
  ObjectiveWeights weights;
  weights.square = options.square;
  if (options.max_gap > 0) { // at the gap the square counts twice as much as the rest
    constexpr double at_gap = 2;
    weights.square = std::max(weights.square, at_gap / options.max_gap);
  }
  weights.shape = options.shape;
  weights.between = options.between;
  weights.typical_area = surface_area(start) / (2.0 * static_cast<double>(budget));
  weights.typical_area *= options.extent == CageExtent::half ? 2 : 1;
  set_emphasis(weights, model, options.density);
  return weights;
}

class Improvement {
public:
  Improvement(TriangleView start, const ModelSurface& surface, const ImproveOptions& options)
      : options_(options), surface_(surface),
        guard_(surface_, options.clearance * surface_.diagonal),
        cage_(start, options.extent, options.parts, options.bands),
        budget_(vertex_budget(cage_.mesh, options)),
        objective_(surface_, weights_for(start, surface.mesh, options, budget_)),
        most_valence_(static_cast<std::size_t>(options.most_valence)) {}

  Result<Improved> run(const Progress& progress) {
    const Clock::time_point begin = Clock::now();
    if (options_.max_gap > 0) {
      coarsen_within_gap(progress.part(0, 0.9));
    }
    if (options_.max_gap == 0 || over_budget()) {
      objective_.limit_gap(std::numeric_limits<double>::infinity());
      simplify_to_budget(progress.part(0, 0.4));
    }
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    Improved result;
    result.report.simplify_seconds = seconds_since(begin);
    const Clock::time_point middle = Clock::now();
    const bool within_gap = std::isfinite(objective_.weights().most_gap);
    const double value =
        within_gap ? relax_steps(4, progress.part(0.9, 1)) : refine(progress.part(0.4, 1));
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    result.cage = cage_.mesh.compact();
    if (!options_.parts.empty()) {
      result.parts = cage_.mesh.compact_parts();
    }
    result.report.refine_seconds = seconds_since(middle);
    const double sides = cage_.mesh.is_half() ? 2 : 1;
    double plain = value; // comparable with cages that were made without regard to webs
    if (options_.between != nullptr) {
      objective_.allow_webs();
      plain = objective_.total(cage_.mesh);
    }
    result.report.objective = sides * plain / maths::cube(surface_.diagonal);
    result.report.reached = cage_.mesh.vertex_count() <= budget_;
    if (!result.report.reached) {
      result.report.why_not =
          "no edge of the cage can be collapsed any more without coming nearer to the model than "
          "the clearance, or crossing itself";
    }
    return result;
  }

private:
  void simplify_to_budget(const Progress& progress) {
    if (options_.max_gap == 0) {
      make_enough(progress.part(0, 0.1));
    }
    reduce(Placement::outside_patch, std::max(budget_, careful_from(budget_)),
           progress.part(0.1, 0.2));
    reduce(Placement::clear_of_model, budget_, progress.part(0.2, 1));
    if (over_budget() && !options_.draft) {
      get_unstuck(progress.part(1, 1));
    }
  }

  // Boxes may have hardly more vertices than there may be, or fewer, and none but at their corners:
  // there is little to choose from until long edges are split.
  void make_enough(const Progress& progress) {
    constexpr std::size_t enough = 3; // times the budget
    if ((options_.vertices > 0 || options_.faces > 0) &&
        cage_.mesh.vertex_count() < enough * budget_) {
      split_long_edges(cage_, guard_, enough * budget_, most_valence_);
      relax_steps(4, progress);
    }
  }

  // A cage that is stuck may have grown into its own way: tightened, and with less regard to the
  // shape of its faces, it often goes on; if not, it may do so with other edges.
  void get_unstuck(const Progress& progress) {
    const WorkingCage stuck = cage_;
    const std::size_t most_valence = most_valence_;
    const ShapeLimits limits = limits_;
    std::optional<WorkingCage> smallest;
    for (const bool with_flips : {false, true}) {
      cage_ = stuck;
      most_valence_ = most_valence;
      limits_ = limits;
      constexpr int attempts = 3;
      for (int i = 0; i < attempts && over_budget() && !progress.cancelled(); ++i) {
        with_flips ? settle(4, progress) : relax_steps(4, progress);
        most_valence_ += shape_limits::more_valence_if_stuck;
        limits_.worst_defect *= shape_limits::worse_defect_if_stuck;
        limits_.least_quality = shape_limits::least_quality_if_stuck;
        limits_.sharpest_bend = shape_limits::sharpest_bend_if_stuck(limits_.sharpest_bend);
        reduce(Placement::clear_of_model, budget_, progress);
      }
      if (!smallest || cage_.mesh.vertex_count() < smallest->mesh.vertex_count()) {
        smallest = cage_;
      }
      if (!over_budget()) {
        break;
      }
    }
    cage_ = std::move(*smallest);
  }

  // Tightens the cage, and moves vertices to where they pay: splits where a new vertex helps most,
  // then collapses what costs least. \returns the objective
  double refine(const Progress& progress) {
    double best = settle(2, progress.part(0, 0.1));
    if (options_.draft) {
      return best;
    }
    WorkingCage kept = cage_;
    std::size_t count = std::max(budget_, cage_.mesh.vertex_count());
    // Of so many vertices one is moved elsewhere in a round: many at first, and fewer whenever that
    // has gained little. Changes that do not pay together may do so one by one.
    std::size_t share = 3;
    for (int round = 0; round < options_.rounds && !progress.cancelled(); ++round) {
      const double begin = 0.1 + 0.8 * round / options_.rounds;
      const double value = move_vertices(std::max(fewest, count / share),
                                         progress.part(begin, begin + 0.8 / options_.rounds));
      const std::size_t made = cage_.mesh.vertex_count();
      const bool fewer = made < count && count > budget_;
      constexpr double worth_the_same_again = 0.998;
      const bool pays = made <= count && (value <= worth_the_same_again * best || fewer);
      if (made <= count && (value < best || fewer)) {
        count = std::max(budget_, made);
        best = value;
        kept = cage_;
      } else {
        cage_ = kept;
      }
      if (!pays && count / share <= fewest) {
        break;
      }
      share *= pays ? 1 : 2;
    }
    if (!over_budget() && blunt_tips(best, progress.part(0.8, 0.9))) {
      objective_.limit_gap(farthest()); // or they grow again
    }
    const double value = settle_shapes(progress.part(0.9, 1));
    objective_.limit_gap(std::numeric_limits<double>::infinity());
    return value;
  }

  struct Tip {
    Index vertex = 0;
    double distance = 0; // from the model
    double worth = 0;    // what the objective may grow by if it gets much nearer
  };

  // The objective hardly feels a thin spike, but users see it first. Tips that stand off the model
  // far more than the rest of the cage are drawn in with all round them; or split, and vertices
  // elsewhere are given for that; or made to feel it, as long as that costs little.
  // \returns whether any was
  bool blunt_tips(double value, const Progress& progress) {
    constexpr int attempts = 16;
    constexpr int patience = 4;
    int in_vain = 0;
    bool is_any = false;
    std::vector<Index> tried;
    for (int i = 0; i < attempts && in_vain < patience && !progress.cancelled(); ++i) {
      const std::optional<Tip> tip = farthest_tip(tried);
      if (!tip) {
        break;
      }
      tried.push_back(tip->vertex);
      const bool is_fault = tip->distance > shape_limits::far_tip * objective_.diagonal();
      const bool better = pays(*tip, value, progress, [&] { return shave_or_split(*tip); }) ||
                          (is_fault && pays(*tip, value, progress, [&] { return draw_in(*tip); }));
      in_vain += better ? 0 : is_fault ? 1 : 2;
      is_any = is_any || better;
    }
    objective_.limit_gap(std::numeric_limits<double>::infinity());
    return is_any;
  }

  // Makes a change for the sake of a tip and takes it back unless the tip gets nearer at little
  // cost, which is added to the value. \returns whether it did
  template <class Change>
  bool pays(const Tip& tip, double& value, const Progress& progress, const Change& change) {
    const WorkingCage kept = cage_;
    const double before = standing_off();
    if (change()) {
      constexpr double shorter = 0.75;
      const double fault = shape_limits::far_tip * objective_.diagonal();
      objective_.limit_gap(tip.distance > fault ? std::min(shorter * tip.distance, fault)
                                                : shorter * tip.distance);
      reduce(Placement::clear_of_model, budget_, progress);
      const double after = settle(2, progress);
      constexpr double gain = 1 - nearer_tip * nearer_tip;
      const bool much_nearer = standing_off() < before - gain * maths::square(tip.distance);
      if (!over_budget() && after < value + (much_nearer ? tip.worth : 0)) {
        value = after;
        return true;
      }
    }
    cage_ = kept;
    return false;
  }

  bool shave_or_split(const Tip& tip) {
    const std::size_t before = cage_.mesh.vertex_count();
    if (shave_tip(cage_, guard_, objective_, tip.vertex, most_valence_)) {
      // More than were saved: of a few the most promising are often not the ones that can be made.
      const std::size_t more = std::max(fewest, budget_ / 8);
      split_edges(cage_, guard_, objective_, before - cage_.mesh.vertex_count() + more,
                  most_valence_);
      return true;
    }
    return split_tip(cage_, guard_, objective_, tip.vertex, most_valence_) &&
           distance_of(tip.vertex) < nearer_tip * tip.distance;
  }

  // What is round the tip is made wider and shorter.
  bool draw_in(const Tip& tip) {
    std::vector<Index> movable = cage_.mesh.neighbors(tip.vertex);
    movable.push_back(tip.vertex);
    constexpr double weights[] = {0.3, 3, 30}; // ten times as much until it is near enough
    for (const double weight : weights) {
      objective_.weigh_tips(weight);
      relax(cage_, guard_, objective_, {.steps = 6, .movable = movable});
      if (distance_of(tip.vertex) <= shape_limits::far_tip * objective_.diagonal()) {
        break;
      }
    }
    objective_.weigh_tips(0);
    return distance_of(tip.vertex) < nearer_tip * tip.distance;
  }

  // The vertex farthest from the model of those not tried, if it is far.
  [[nodiscard]] std::optional<Tip> farthest_tip(const std::vector<Index>& tried) const {
    constexpr double far = 5;      // times the mean
    constexpr double least = 0.02; // of the diagonal: less is hardly seen
    constexpr double worth = 0.02; // of what there is between cage and model
    constexpr double worth_of_a_fault = 0.08;
    const CageMesh& mesh = cage_.mesh;
    double area = 0;
    double sum = 0;
    double gaps = 0;
    Tip tip;
    for (Index f = 0; f < mesh.face_end(); ++f) {
      if (mesh.has_face(f)) {
        const Corners t = corners_of(mesh, f);
        area += triangle_area(t);
        sum += triangle_area(t) * objective_.nearest((t[0] + t[1] + t[2]) / 3).distance;
        gaps += objective_.face(t);
      }
    }
    for (Index v = 0; v < mesh.vertex_end(); ++v) {
      if (mesh.has_vertex(v) && std::find(tried.begin(), tried.end(), v) == tried.end()) {
        const double d = distance_of(v);
        if (d > tip.distance) {
          tip.vertex = v;
          tip.distance = d;
        }
      }
    }
    const bool is_fault = tip.distance > shape_limits::far_tip * objective_.diagonal();
    tip.worth = (is_fault ? worth_of_a_fault : worth) * gaps;
    const bool is_far =
        tip.distance > least * objective_.diagonal() && tip.distance * area > far * sum;
    return is_far ? std::optional(tip) : std::nullopt;
  }

  // The greatest distance of a vertex from the model.
  [[nodiscard]] double farthest() const {
    double most = 0;
    for (const double d : distances()) {
      most = std::max(most, d);
    }
    return most;
  }

  // How far the vertices are from the model: the sum of the squares.
  [[nodiscard]] double standing_off() const {
    double sum = 0;
    for (const double d : distances()) {
      sum += maths::square(d);
    }
    return sum;
  }

  [[nodiscard]] std::vector<double> distances() const {
    std::vector<double> all;
    for (Index v = 0; v < cage_.mesh.vertex_end(); ++v) {
      if (cage_.mesh.has_vertex(v)) {
        all.push_back(distance_of(v));
      }
    }
    return all;
  }

  [[nodiscard]] double distance_of(Index v) const {
    return objective_.nearest(cage_.mesh.position(v)).distance;
  }

  // Splits edges, and collapses as many.
  double move_vertices(std::size_t count, const Progress& progress) {
    split_edges(cage_, guard_, objective_, count, most_valence_);
    flip_edges(cage_, guard_, objective_, most_valence_);
    relax_steps(1, progress.part(0, 0.1));
    reduce(Placement::clear_of_model, budget_, progress.part(0.1, 0.6));
    return settle(2, progress.part(0.6, 1));
  }

  // Tightens the cage for the last time, without needles. If too many faces are thin then, their
  // shape is made to count more until it is better. \returns the objective,
  // as it was weighted before
  double settle_shapes(const Progress& progress) {
    mend_needles(cage_, guard_, objective_, shape_limits::mended, most_valence_);
    relax_steps(2, progress.part(0, 0.25));
    const double weight = objective_.weights().shape;
    constexpr int attempts = 3;
    constexpr double dearer = 3;
    for (int i = 1; i <= attempts && has_thin_faces() && !progress.cancelled(); ++i) {
      objective_.weigh_shape(weight * maths::pow(dearer, i));
      settle(4, progress.part(0.25 * i, 0.25 * (i + 1)));
    }
    round_needles(weight);
    objective_.weigh_shape(weight);
    return objective_.total(cage_.mesh);
  }

  // Makes the shape of faces count above all for vertices round a needle, and more so if one is
  // left.
  void round_needles(double weight) {
    constexpr int attempts = 4;
    constexpr double dearer = 10;
    for (int i = 1; i <= attempts; ++i) {
      std::vector<Index> movable;
      for (Index f = 0; f < cage_.mesh.face_end(); ++f) {
        if (cage_.mesh.has_face(f) &&
            shape_quality(corners_of(cage_.mesh, f)) < shape_limits::nearly_a_needle) {
          for (const Index v : cage_.mesh.face(f)) {
            const std::vector<Index> beside = cage_.mesh.neighbors(v);
            movable.insert(movable.end(), beside.begin(), beside.end());
          }
        }
      }
      if (movable.empty()) {
        return;
      }
      std::sort(movable.begin(), movable.end());
      movable.erase(std::unique(movable.begin(), movable.end()), movable.end());
      objective_.weigh_shape(weight * maths::pow(dearer, i));
      cage_.reach = std::numeric_limits<double>::infinity();
      relax(cage_, guard_, objective_, {.steps = 6, .movable = movable});
    }
  }

  // Whether too many faces are long and thin, or nearly so.
  [[nodiscard]] bool has_thin_faces() const {
    std::size_t count = 0;
    for (Index f = 0; f < cage_.mesh.face_end(); ++f) {
      count += cage_.mesh.has_face(f) &&
                       shape_quality(corners_of(cage_.mesh, f)) < shape_limits::nearly_thin
                   ? 1
                   : 0;
    }
    const auto faces = static_cast<double>(cage_.mesh.face_count());
    return static_cast<double>(count) >= shape_limits::few_thin * faces;
  }

  // As few vertices as the gap allows. A cage that is a little too coarse is refined where it is
  // too far away, and then edges are collapsed until none is left that can go without that.
  void coarsen_within_gap(const Progress& progress) {
    const double limit = options_.max_gap * surface_.diagonal;
    // So many vertices are usually too few: gaps fall about with the power 0.8 of their number.
    const double guess = 1.6 * maths::pow(options_.max_gap, -1.25);
    const auto coarse =
        std::clamp(static_cast<std::size_t>(guess), fewest, std::max(fewest, budget_));
    reduce(Placement::outside_patch, careful_from(coarse), progress.part(0, 0.05));
    reduce(Placement::clear_of_model, coarse, progress.part(0.05, 0.2));
    settle(4, progress.part(0.2, 0.3));
    constexpr int most_splits = 12;
    std::size_t least_far = std::numeric_limits<std::size_t>::max();
    int in_vain = 0;
    for (int i = 0; i < most_splits && !progress.cancelled(); ++i) {
      const std::size_t before = cage_.mesh.vertex_count();
      const std::size_t far = split_far_faces(cage_, guard_, objective_, limit, most_valence_);
      if (far > 0 && cage_.mesh.vertex_count() < before + 2) { // make room round them
        split_edges(cage_, guard_, objective_, 4 + before / 16, most_valence_);
      }
      constexpr int patience = 4;
      in_vain = far < least_far ? 0 : in_vain + 1;
      least_far = std::min(least_far, far);
      if (far == 0 || in_vain == patience || cage_.mesh.vertex_count() > 16 + 3 * coarse / 2) {
        break;
      }
      flip_edges(cage_, guard_, objective_, most_valence_);
      relax_steps(3, progress.part(0.3 + 0.3 * i / most_splits, 0.3 + 0.3 * (i + 1) / most_splits));
    }
    objective_.limit_gap(limit);
    WorkingCage kept = cage_;
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds && !progress.cancelled(); ++round) {
      const Progress part =
          progress.part(0.6 + 0.4 * round / most_rounds, 0.6 + 0.4 * (round + 1) / most_rounds);
      reduce(Placement::clear_of_model, fewest, part.part(0, 0.5));
      settle(4, part.part(0.5, 1));
      if (cage_.mesh.vertex_count() >= kept.mesh.vertex_count()) {
        break;
      }
      kept = cage_;
    }
    cage_ = std::move(kept);
  }

  // With how many vertices the careful way of simplifying begins, if so many are to be left.
  [[nodiscard]] std::size_t careful_from(std::size_t vertices) const {
    if (options_.draft) {
      return 2 * vertices;
    }
    constexpr std::size_t more = 300; // the coarser the cage, the more each collapse matters
    return static_cast<std::size_t>(options_.careful_from * static_cast<double>(vertices)) + more;
  }

  [[nodiscard]] bool over_budget() const { return cage_.mesh.vertex_count() > budget_; }

  void reduce(Placement placement, std::size_t vertices, const Progress& progress) {
    simplify(cage_, guard_, objective_,
             {.vertices = vertices,
              .placement = placement,
              .most_valence = most_valence_,
              .limits = limits_},
             progress);
  }

  double relax_steps(int steps, const Progress& progress) {
    return relax(cage_, guard_, objective_, {.steps = steps}, progress);
  }

  double settle(int steps, const Progress& progress) {
    flip_edges(cage_, guard_, objective_, most_valence_);
    relax_steps(steps / 2, progress.part(0, 0.5));
    flip_edges(cage_, guard_, objective_, most_valence_);
    return relax_steps(steps - steps / 2, progress.part(0.5, 1));
  }

  static constexpr std::size_t fewest = 4;  // vertices of a closed surface
  static constexpr double nearer_tip = 0.9; // times as far: worth the while

  ImproveOptions options_;
  const ModelSurface& surface_;
  Guard guard_;
  WorkingCage cage_;
  std::size_t budget_;
  Objective objective_;
  std::size_t most_valence_;
  ShapeLimits limits_;
};

Status check(TriangleView start, TriangleView model, const ImproveOptions& options) {
  if (start.triangles.empty()) {
    return Error{ErrorCode::invalid_cage, "the cage to start from has no faces"};
  }
  if (model.positions.empty()) {
    return Error{ErrorCode::unfit_model, "the model has no vertices"};
  }
  if (!(options.clearance > 0 && options.clearance < 1)) {
    return Error{ErrorCode::invalid_option, "the clearance must be above 0 and below 1"};
  }
  if (options.vertices < 0 || options.faces < 0 || options.rounds < 0 || options.most_valence < 5 ||
      !(options.square >= 0) || !(options.max_gap >= 0) || !(options.shape >= 0) ||
      !(options.careful_from >= 1)) {
    return Error{ErrorCode::invalid_option, "an option of the improvement is out of its range"};
  }
  if (!options.density.empty() && options.density.size() != model.positions.size()) {
    return Error{ErrorCode::invalid_option, "there are " + std::to_string(options.density.size()) +
                                                " densities, but the model has " +
                                                std::to_string(model.positions.size()) +
                                                " vertices"};
  }
  if (!options.parts.empty() && options.parts.size() != start.triangles.size()) {
    return Error{ErrorCode::invalid_option, "there must be one part for each face of the start"};
  }
  if (!options.bands.empty() &&
      std::any_of(options.parts.begin(), options.parts.end(),
                  [&](Index part) { return part >= options.bands.size(); })) {
    return Error{ErrorCode::invalid_option, "there must be a band for each part"};
  }
  if (!std::all_of(options.density.begin(), options.density.end(),
                   [](double d) { return d > 0 && std::isfinite(d); })) {
    return Error{ErrorCode::invalid_option, "a density is not a finite number above 0"};
  }
  return success();
}

} // namespace

Result<Improved> improve(TriangleView start, const ModelSurface& model,
                         const ImproveOptions& options, const Progress& progress) {
  if (const Status good = check(start, model.mesh, options); !good) {
    return good.error();
  }
  return Improvement(start, model, options).run(progress);
}

Result<Improved> improve(TriangleView start, TriangleView model, const ImproveOptions& options,
                         const Progress& progress) {
  if (const Status good = check(start, model, options); !good) {
    return good.error();
  }
  const ModelSurface surface(model, options.diagonal);
  return Improvement(start, surface, options).run(progress);
}

} // namespace cagewright
