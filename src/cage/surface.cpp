#include "cage/surface.h"

#include "cage/best_of.h"
#include "cage/budget.h"
#include "cage/ground.h"
#include "cage/limb_rings.h"
#include "cage/not_valid.h"
#include "cage/quad_stage.h"
#include "cage/stage_time.h"
#include "cage/start.h"
#include "cage/triangle_stage.h"
#include "cage/unit_frame.h"
#include "quads/quad_merit.h"
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
constexpr double chosen = 0.25; // if the start is the best of several
constexpr double improved = 0.97;
constexpr double rivalled = 0.6;     // until then, if there is a rival
constexpr double limbs_found = 0.05; // of the improvement

/// A checked cage, and what is known of its start alone.
struct Surface {
  GeneratedCage cage;
  int known = 0;      ///< see Start
  double webbing = 0; ///< SpaceBetween::share_inside()
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
  ImproveOptions budget = ground.budget(start.clearance);
  const LimbRings rings =
      options.joints.empty()
          ? LimbRings()
          : rings_at_joints(start.surface, ground.joints_here(), vertices_allowed(options));
  if (rings.count > 0) {
    budget.parts = rings.parts;
    budget.bands = rings.bands;
  }
  const auto well_shaped = [&](const ImproveOptions& asked, const Progress& share) {
    return improve_well_shaped(ground, start.surface, asked, share);
  };
  constexpr double usual = 0.9; // of the time, with rings
  const auto run = [&](double from) {
    const Progress share =
        progress.part(from == 0 ? 0 : usual, from == 0 && rings.count > 0 ? usual : 1);
    return options.max_gap > 0
               ? improve_to_gap(ground, start.surface, budget, options.max_gap, share)
               : improve_without_webs(ground, budget, well_shaped, share);
  };
  Result<Triangles> made = run(0);
  if (rings.count > 0 && made && !made->improved.report.reached) {
    budget.parts = {}; // without rings the budget may be enough
    budget.bands = {};
    made = run(1);
  }
  if (!made) {
    return made.error();
  }
  return Made{PolygonMesh(made->improved.cage), std::move(made->improved.parts),
              std::move(made->improved.report), made->gap, made->farthest};
}

/// \param is_first  see QuadTask
Result<Made> quads_on(const Ground& ground, const Start& start, const GenerateOptions& options,
                      bool is_first, Stopwatch& watch, const Progress& progress) {
  const LimbRings rings =
      find_limb_rings(start.surface, ground.model_here(), vertices_allowed(options),
                      ground.joints_here(), progress.part(0, limbs_found));
  watch.lap("limbs");
  Result<QuadStage> stage = make_quads_in_budget({ground, start, options, rings, is_first},
                                                 progress.part(limbs_found, 1));
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
  const double begun = is_open(options, how) ? chosen : started;
  Stopwatch watch(cage.times);
  Result<Start> start = make_start(ground, options, how, progress.part(0, begun));
  if (!start) {
    return start.error();
  }
  watch.lap(start->method == Method::envelope ? "envelope" : "boxes");

  const double end = start->rival ? rivalled : 1;
  const double checking = end - (1 - improved);
  const Progress improving = progress.part(begun, checking);
  const bool is_first = start->method == Method::envelope && how.envelope.resolution == 0 &&
                        how.envelope_vertices == 0 && options.max_gap == 0;
  Result<Made> made = options.quads ? quads_on(ground, *start, options, is_first, watch, improving)
                                    : triangles_on(ground, *start, options, improving);
  if (!made) {
    return made.error();
  }
  watch.lap("improve");

  Ground::WholeCage whole = ground.whole(made->faces);
  const Result<ValidityReport> validity = validate_cage(
      whole.faces, ground.model(), {.first_only = true}, progress.part(checking, end));
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
  }
  if (!made->parts.empty()) {
    std::vector<Index> parts = std::move(made->parts); // of both halves
    if (ground.is_half()) {
      const std::vector<Index> one = parts;
      parts.insert(parts.end(), one.begin(), one.end());
    }
    cage.limb_rings = rings_between(cage.faces, parts);
  }
  add_remarks(cage, *start, *made, options);
  surface.known = start->known;
  surface.webbing = ground.between().share_inside(ground.with_image(to_triangle_mesh(made->faces)));
  surface.rival = start->rival;
  return surface;
}

/// Whether limbs are joined that finer voxels may set free. Where handles of the model had to be
/// filled to keep to the budget, finer voxels would only bring them back.
bool may_finer_voxels_help(const Surface& made, double least_webbing) {
  return made.cage.method == Method::envelope && is_within_budget(made.cage) &&
         made.cage.genus >= made.known &&
         (made.webbing >= least_webbing || made.cage.genus > made.known);
}

/// Makes one surface after another, and keeps the best.
class Tries {
public:
  Tries(TriangleView model, const GenerateOptions& options, const Mirroring& mirroring)
      : model_(model), options_(options), mirroring_(mirroring), best_of_(cost_of) {}
  Tries(const Tries&) = delete;
  Tries& operator=(const Tries&) = delete;

  /// From a start, by halves if there is a plane; on the whole model if there is none, or that
  /// fails and need not be.
  bool make(const StartTry& how, const Progress& progress) {
    std::string why_not = mirroring_.why_not;
    constexpr double usual = 0.9; // of the time: halves hardly ever fail
    if (mirroring_.plane) {
      Result<Surface> made =
          make_on(half(), options_, how, progress.part(0, mirroring_.is_insisted_on ? 1 : usual));
      if (made || mirroring_.is_insisted_on || made.error().code == ErrorCode::cancelled) {
        return add(std::move(made));
      }
      why_not = made.error().message;
    }
    return make_whole(how, why_not, progress.part(mirroring_.plane ? usual : 0, 1));
  }

  /// On the whole model.
  /// \param why_not  the cage is not mirrored; empty: that was not asked for
  bool make_whole(const StartTry& how, const std::string& why_not, const Progress& progress) {
    Result<Surface> made = make_on(whole(), options_, how, progress);
    if (made && !why_not.empty()) {
      cagewright::add(made->cage, {Reason::not_mirrored, why_not, mirroring_.is_insisted_on, {}});
    }
    return add(std::move(made));
  }

  /// On the same ground as the best, as it is not mirrored for the same reason.
  bool make_beside_best(const StartTry& how, const Progress& progress) {
    if (best().cage.mirror) {
      return add(make_on(half(), options_, how, progress));
    }
    const Remark* why_not = best().cage.find(Reason::not_mirrored);
    return make_whole(how, why_not == nullptr ? std::string() : why_not->message, progress);
  }

  [[nodiscard]] const Surface& best() const { return best_of_.best(); }
  [[nodiscard]] bool may_go_on() const { return runs_.are_left(); }

  [[nodiscard]] Result<GeneratedCage> taken() {
    Result<Surface> surface = best_of_.taken();
    if (!surface) {
      return surface.error();
    }
    surface->cage.times = std::move(times_);
    return std::move(surface->cage);
  }

private:
  /// Beyond the budget the smallest is the best.
  static Cost cost_of(const Surface& made) {
    if (!is_within_budget(made.cage)) {
      return {true, static_cast<double>(made.cage.faces.positions.size()), 0};
    }
    double shapes = 1;
    if (const std::optional<QuadReport>& quads = made.cage.quads) {
      constexpr double for_thin = 5; // another start, unlike other quads of one, may do without
      shapes = dearer_by_shapes(*quads, shape_limits::enough_quads) *
               dearer_by_thin(quads->thin, for_thin);
    }
    return {false,
            made.cage.objective * shapes * dearer_by(made.webbing, made.cage.genus, made.known), 0};
  }

  bool add(Result<Surface> made) {
    if (made) {
      times_.insert(times_.end(), made->cage.times.begin(), made->cage.times.end());
    }
    return best_of_.add(std::move(made));
  }

  const Ground& half() {
    return half_ ? *half_ : half_.emplace(model_, options_, mirroring_.plane, runs_);
  }
  const Ground& whole() {
    return whole_ ? *whole_ : whole_.emplace(model_, options_, std::nullopt, runs_);
  }

  TriangleView model_;
  const GenerateOptions& options_;
  const Mirroring& mirroring_;
  EngineRuns runs_;
  std::optional<Ground> half_;
  std::optional<Ground> whole_;
  BestOf<Surface, decltype(&cost_of)> best_of_;
  std::vector<StageTime> times_;
};

} // namespace

Result<GeneratedCage> make_surface(TriangleView model, const GenerateOptions& options,
                                   const Mirroring& mirroring, const Progress& progress) {
  if (const Result<UnitFrame> frame = unit_frame(model); !frame) {
    return frame.error();
  }
  const StartTry start = first_start(options);
  constexpr double usual = 0.8; // of the time: seldom is there a third start, or a fifth
  constexpr double first = rivalled * usual;
  Tries tries(model, options, mirroring);
  if (!tries.make(start, progress.part(0, usual))) {
    return tries.taken();
  }
  const auto is_enough = [&] { return is_within_budget(tries.best().cage) || !tries.may_go_on(); };
  const bool is_chosen = options.envelope_resolution == 0 && options.max_gap == 0;
  if (!is_chosen) {
    return tries.taken();
  }
  // A mirrored cage needs vertices on its plane: so few may not do.
  if (!is_enough() && tries.best().cage.mirror && !mirroring.is_insisted_on &&
      !tries.make_whole(start, "a mirrored cage takes more vertices than asked for",
                        progress.part(first, usual))) {
    return tries.taken();
  }
  const std::optional<StartTry> rival = tries.best().rival;
  if (rival && tries.may_go_on() && !tries.make_beside_best(*rival, progress.part(first, usual))) {
    return tries.taken();
  }
  double done = usual;
  double least_webbing = webbed;
  for (const StartTry& finer : starts_of_finer_voxels(options, tries.best().cage.resolution)) {
    if (!may_finer_voxels_help(tries.best(), least_webbing) || !tries.may_go_on()) {
      break;
    }
    const double then = (done + 1) / 2;
    if (!tries.make_beside_best(finer, progress.part(done, then))) {
      return tries.taken();
    }
    done = then;
    if (tries.best().cage.bridges > 0) {
      break; // what joins pieces that are apart is a web, too, however fine the voxels are
    }
    least_webbing = plainly_webbed;
  }
  for (const StartTry& simpler : starts_of_fewer_handles(options)) {
    const double then = (done + 1) / 2;
    if (is_enough() || tries.best().cage.genus == 0 ||
        !tries.make(simpler, progress.part(done, then))) {
      break;
    }
    done = then;
  }
  return tries.taken();
}

} // namespace cagewright
