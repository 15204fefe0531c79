#include "cage/surface.h"

#include "cage/budget.h"
#include "cage/ground.h"
#include "cage/limb_rings.h"
#include "cage/merit.h"
#include "cage/not_valid.h"
#include "cage/quad_stage.h"
#include "cage/stage_time.h"
#include "cage/start.h"
#include "cage/triangle_stage.h"
#include "cage/unit_frame.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>
#include <cagewright/validate/webbing.h>

#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// Shares of the time that one surface takes.
constexpr double started = 0.1;
constexpr double improved = 0.95;
constexpr double limbs_found = 0.05; // of the improvement

/// A checked cage, and what is known of its start alone.
struct Surface {
  GeneratedCage cage;
  int known = 0; ///< see Start
  std::optional<StartTry> rival;
};

/// What is made on a ground, before it is joined with its mirror image.
struct Made {
  PolygonMesh faces;
  std::vector<Index> parts; ///< of the faces: see LimbRings
  ImproveReport report;
  std::optional<double> gap;
  std::optional<Vec3> farthest;
};

Result<Made> triangles_on(const Ground& ground, const Start& start, const GenerateOptions& options,
                          const Progress& progress) {
  const ImproveOptions budget = ground.budget(start.clearance);
  Result<Triangles> made =
      options.max_gap > 0 ? improve_to_gap(ground, start.surface, budget, options.max_gap, progress)
                          : improve_well_shaped(ground, start.surface, budget, progress);
  if (!made) {
    return made.error();
  }
  return Made{PolygonMesh(made->improved.cage),
              {},
              std::move(made->improved.report),
              made->gap,
              made->farthest};
}

Result<Made> quads_on(const Ground& ground, const Start& start, const GenerateOptions& options,
                      Stopwatch& watch, const Progress& progress) {
  const LimbRings rings = find_limb_rings(start.surface, ground.model_here(),
                                          vertices_allowed(options), progress.part(0, limbs_found));
  watch.lap("limbs");
  Result<QuadStage> stage =
      make_quads_in_budget({ground, start, options, rings}, progress.part(limbs_found, 1));
  if (!stage) {
    return stage.error();
  }
  return Made{std::move(stage->made.cage), std::move(stage->made.parts), std::move(stage->report),
              stage->gap, std::nullopt};
}

void add_remarks(GeneratedCage& cage, const Start& start, const Made& made,
                 const GenerateOptions& options) {
  if (!made.report.reached) {
    const bool is_gap = options.max_gap > 0 && !(cage.gap && *cage.gap <= options.max_gap);
    add(cage, {is_gap ? Reason::gap_not_kept : Reason::budget_not_reached, made.report.why_not,
               true, made.farthest});
  }
  if (start.clearance < options.clearance) {
    add(cage, {Reason::clearance_not_kept,
               "the boxes came nearer to the model than the clearance asked for",
               true,
               {}});
  }
  if (!start.why_not_boxes.empty()) {
    add(cage, {Reason::boxes_not_possible, start.why_not_boxes, true, {}});
  }
}

/// A checked cage from one start on one ground.
Result<Surface> make_on(const Ground& ground, const GenerateOptions& options, const StartTry& how,
                        const Progress& progress) {
  Surface surface;
  GeneratedCage& cage = surface.cage;
  Stopwatch watch(cage.times);
  Result<Start> start = make_start(ground, options, how, progress.part(0, started));
  if (!start) {
    return start.error();
  }
  watch.lap(start->method == Method::envelope ? "envelope" : "boxes");

  const Progress improving = progress.part(started, improved);
  Result<Made> made = options.quads ? quads_on(ground, *start, options, watch, improving)
                                    : triangles_on(ground, *start, options, improving);
  if (!made) {
    return made.error();
  }
  watch.lap("improve");

  Ground::WholeCage whole = ground.whole(made->faces);
  const Result<ValidityReport> validity =
      validate_cage(whole.faces, ground.model(), {.first_only = true}, progress.part(improved, 1));
  if (!validity) {
    return validity.error();
  }
  if (!validity->valid()) {
    return not_valid(*validity, ground.is_half() ? "try another resolution, or no symmetry"
                                                 : "try another resolution");
  }
  watch.lap("check");

  cage.faces = std::move(whole.faces);
  cage.mirror = std::move(whole.mirror);
  cage.triangles = to_triangle_mesh(cage.faces);
  cage.method = start->method;
  cage.start_vertices = ground.vertices_of(start->surface.positions);
  cage.resolution = start->resolution;
  cage.genus = start->genus;
  cage.bridges = start->bridges;
  cage.box_tree = start->boxes;
  cage.objective = made->report.objective;
  cage.clearance = start->clearance;
  cage.gap = made->gap;
  if (options.quads) {
    cage.quads = report_of(cage.faces);
    std::vector<Index> parts = std::move(made->parts); // of both halves
    if (ground.is_half()) {
      const std::vector<Index> one = parts;
      parts.insert(parts.end(), one.begin(), one.end());
    }
    cage.limb_rings = rings_between(cage.faces, parts);
  }
  add_remarks(cage, *start, *made, options);
  surface.known = start->known;
  surface.rival = start->rival;
  return surface;
}

/// By halves if there is a plane; on the whole model if there is none, or that fails and need not
/// be.
Result<Surface> make_from(TriangleView model, const GenerateOptions& options,
                          const Mirroring& mirroring, const StartTry& how,
                          const Progress& progress) {
  std::string why_not = mirroring.why_not;
  constexpr double usual = 0.9; // of the time: halves hardly ever fail
  if (mirroring.plane) {
    const Ground half(model, options, mirroring.plane);
    Result<Surface> made =
        make_on(half, options, how, progress.part(0, mirroring.is_insisted_on ? 1 : usual));
    if (made || mirroring.is_insisted_on || made.error().code == ErrorCode::cancelled) {
      return made;
    }
    why_not = made.error().message;
  }
  const Ground whole(model, options, std::nullopt);
  Result<Surface> made =
      make_on(whole, options, how, progress.part(mirroring.plane ? usual : 0, 1));
  if (made && !why_not.empty()) {
    add(made->cage, {Reason::not_mirrored, why_not, mirroring.is_insisted_on, {}});
  }
  return made;
}

/// Makes one surface after another, and keeps the best.
class Tries {
public:
  Tries(TriangleView model, const GenerateOptions& options) : model_(model), options_(options) {}

  /// A try that fails is no worse than none, unless it is the first.
  Status make(const Mirroring& mirroring, const StartTry& how, const Progress& progress) {
    Result<Surface> made = make_from(model_, options_, mirroring, how, progress);
    if (!made) {
      return best_ && made.error().code != ErrorCode::cancelled ? success() : made.error();
    }
    times_.insert(times_.end(), made->cage.times.begin(), made->cage.times.end());
    if (!best_ || is_better(*made)) {
      best_ = std::move(*made);
    }
    return success();
  }

  [[nodiscard]] const Surface& best() const { return *best_; }
  [[nodiscard]] bool is_within_budget() const { return cagewright::is_within_budget(best_->cage); }

  [[nodiscard]] GeneratedCage taken() {
    best_->cage.times = std::move(times_);
    return std::move(best_->cage);
  }

private:
  /// Beyond the budget the smallest is the best.
  [[nodiscard]] bool is_better(const Surface& other) const {
    const bool is_within = cagewright::is_within_budget(other.cage);
    if (is_within != is_within_budget()) {
      return is_within;
    }
    return is_within ? cost_of(other) < cost_of(*best_)
                     : other.cage.faces.positions.size() < best_->cage.faces.positions.size();
  }

  [[nodiscard]] double cost_of(const Surface& made) const {
    const double webbing = SpaceBetween(model_).share_inside(made.cage.triangles);
    return made.cage.objective * dearer_by(webbing, made.cage.genus, made.known);
  }

  TriangleView model_;
  const GenerateOptions& options_;
  std::optional<Surface> best_;
  std::vector<StageTime> times_;
};

} // namespace

Result<GeneratedCage> make_surface(TriangleView model, const GenerateOptions& options,
                                   const Mirroring& mirroring, const Progress& progress) {
  if (const Result<UnitFrame> frame = unit_frame(model); !frame) {
    return frame.error();
  }
  constexpr double first = 0.5; // of the time
  constexpr double usual = 0.9; // hardly ever is there a third start
  Tries tries(model, options);
  const StartTry start = first_start(options);
  if (const Status made = tries.make(mirroring, start, progress.part(0, first)); !made) {
    return made.error();
  }
  const bool is_chosen = options.envelope_resolution == 0 && options.max_gap == 0;
  if (!is_chosen) {
    return tries.taken();
  }
  // A mirrored cage needs vertices on its plane: so few may not do.
  if (!tries.is_within_budget() && tries.best().cage.mirror && !mirroring.is_insisted_on) {
    const Mirroring none{std::nullopt, false, "a mirrored cage takes more vertices than asked for"};
    if (const Status made = tries.make(none, start, progress.part(first, usual)); !made) {
      return made.error();
    }
  }
  if (const std::optional<StartTry> rival = tries.best().rival) {
    const GeneratedCage& cage = tries.best().cage;
    const Remark* why_not = find(cage, Reason::not_mirrored);
    const Mirroring same = cage.mirror
                               ? Mirroring{mirroring.plane, true, ""}
                               : Mirroring{std::nullopt, mirroring.is_insisted_on,
                                           why_not == nullptr ? std::string() : why_not->message};
    if (const Status made = tries.make(same, *rival, progress.part(first, usual)); !made) {
      return made.error();
    }
  }
  double done = usual;
  for (const StartTry& simpler : starts_of_fewer_handles(options)) {
    if (tries.is_within_budget() || tries.best().cage.genus == 0) {
      break;
    }
    const double then = (done + 1) / 2;
    if (const Status made = tries.make(mirroring, simpler, progress.part(done, then)); !made) {
      return made.error();
    }
    done = then;
  }
  return tries.taken();
}

} // namespace cagewright
