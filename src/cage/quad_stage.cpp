#include "cage/quad_stage.h"

#include "cage/budget.h"
#include "cage/merit.h"
#include "cage/triangle_stage.h"
#include "core/maths.h"
#include "quads/grid_quads.h"
#include "quads/quad_merit.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/webbing.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr int attempts = 4;
constexpr double triangles_made = 0.4;  // of the time of an attempt
constexpr double usual_triangles = 1.8; // that one face comes from
constexpr double gap_width = 0.002;     // of the greatest gap: how well it is bounded

/// Counts the cages of triangles that may still be made.
class Runs {
public:
  explicit Runs(const EngineRuns& of_engine) : of_engine_(of_engine) {}
  [[nodiscard]] bool are_left() const { return left_ > 0 && of_engine_.are_left(); }
  void use_one() { --left_; }

private:
  const EngineRuns& of_engine_;
  int left_ = most_runs;
};

constexpr const char* no_smaller = "no smaller cage of quads was found";

bool is_within(const PolygonMesh& cage, const QuadTask& task) {
  const int vertices = vertex_limit(task.options);
  const int faces = task.options.faces;
  return (vertices == 0 ||
          task.ground.vertices_of(cage.positions) <= static_cast<std::size_t>(vertices)) &&
         (faces == 0 || task.ground.faces_of(cage.face_count()) <= static_cast<std::size_t>(faces));
}

/// A cage of blocks, as tight as it gets.
///
/// \param dearest  it is given up if it would cost more; 0: never
Result<QuadStage> quads_of_blocks(const QuadTask& task, const QuadOptions& quads, double loosest,
                                  double dearest, const Progress& progress) {
  // The exchange of loops makes a cage of blocks tighter by so much, and not by more.
  constexpr double gain = 3;
  GridQuadOptions options;
  options.loosest = gain * loosest;
  options.dearest = dearest;
  options.quads = quads;
  options.vertices = vertex_limit(task.options);
  options.faces = task.options.faces;
  options.half = task.ground.is_half();
  Result<Quadrangulated> made = make_grid_quads(task.ground.surface(), options, progress);
  if (!made) {
    return made.error();
  }
  QuadStage stage{{}, std::move(*made), std::nullopt};
  stage.report.reached = is_within(stage.made.cage, task);
  if (!stage.report.reached) {
    stage.report.why_not = no_smaller;
  }
  return stage;
}

/// Whether another try for better shapes could hardly pay.
bool is_well_shaped(const QuadStage& stage) {
  constexpr double nearly = 1.05; // what it is dearer by
  return dearer_by_shapes(stage.made.report, shape_limits::enough_quads) <= nearly;
}

/// Of a half: up to its plane, seen from where what closes it there has no volume.
double volume_of(const PolygonMesh& cage, CageExtent extent) {
  const TriangleMesh mesh = to_triangle_mesh(cage);
  Vec3 origin = bounding_box(TriangleView(mesh)).center();
  if (extent == CageExtent::half) {
    origin.x() = 0;
  }
  return signed_volume(mesh, origin);
}

/// What a cage of quads costs: its volume and what there is between it and the model, times what
/// webs and ill shaped faces add.
class Judge {
public:
  Judge(const QuadTask& task, const QuadOptions& quads, const Progress& progress)
      : ground_(task.ground), quads_(quads),
        between_(ground_.with_image(ground_.surface().mesh), progress) {}

  [[nodiscard]] double looseness_of(const QuadStage& stage) const {
    return looseness(stage.made.cage, ground_.surface(), quads_);
  }

  [[nodiscard]] Cost cost_of(const QuadStage& stage) const {
    const double webbing = webbing_of(to_triangle_mesh(stage.made.cage));
    return {!stage.report.reached,
            objective_of(stage.made.cage) * (1 + webbing) *
                dearer_by_shapes(stage.made.report, shape_limits::enough_quads)};
  }

  /// The least that quads made of them might cost.
  [[nodiscard]] Cost cost_of(const Triangles& made) const {
    return {!made.improved.report.reached,
            objective_of(PolygonMesh(made.improved.cage)) * (1 + webbing_of(made.improved.cage))};
  }

  /// Of the quads themselves, not of the triangles they were made of: see ImproveReport.
  void put_objective(QuadStage& stage) const {
    const double sides = ground_.is_half() ? 2 : 1;
    stage.report.objective =
        sides * objective_of(stage.made.cage) / maths::cube(ground_.diagonal());
  }

  /// Whether limbs are joined so that another start will be tried.
  [[nodiscard]] bool is_webbed(const QuadStage& stage) const {
    return webbing_of(to_triangle_mesh(stage.made.cage)) >= webbed;
  }

  [[nodiscard]] double webbing_of(TriangleMesh cage) const {
    return between_.share_inside(ground_.with_image(std::move(cage)));
  }

private:
  [[nodiscard]] double objective_of(const PolygonMesh& cage) const {
    return volume_of(cage, ground_.extent()) + looseness(cage, ground_.surface(), quads_);
  }

  const Ground& ground_;
  QuadOptions quads_;
  SpaceBetween between_;
};

/// How many triangles are made for so many faces, to begin with.
int triangles_for(int faces) {
  return static_cast<int>(std::lround(usual_triangles * faces));
}

/// Makes triangles that keep the rings of a task, or none, and remembers them: quads are made of
/// the same ones in several ways.
class TriangleTries {
public:
  explicit TriangleTries(const QuadTask& task) : task_(task), runs_(task.ground.runs()) {}

  [[nodiscard]] bool are_left() const { return runs_.are_left(); }

  /// What there is to be made: at most so many faces (0: as the options say) of so many vertices
  /// more than these say, no point farther from the model than max_gap, in diagonals (0: anywhere).
  struct Wish {
    int faces = 0;
    int more_vertices = 0;
    double max_gap = 0;
    bool with_rings = false;

    bool operator==(const Wish&) const = default;
  };

  Result<Triangles> made(const Wish& wish, const Progress& progress) {
    const auto known = std::find_if(known_.begin(), known_.end(),
                                    [&](const auto& one) { return one.first == wish; });
    if (known != known_.end()) {
      return known->second;
    }
    Result<Triangles> triangles = make(wish, progress);
    if (triangles) {
      known_.emplace_back(wish, *triangles);
    }
    return triangles;
  }

private:
  Result<Triangles> make(const Wish& wish, const Progress& progress) {
    ImproveOptions budget = task_.ground.budget(task_.start.clearance);
    budget.faces = wish.faces;
    budget.vertices += wish.more_vertices;
    if (wish.with_rings) {
      budget.parts = task_.rings.parts;
      budget.bands = task_.rings.bands;
    }
    if (wish.max_gap > 0) {
      runs_.use_one();
      return improve_to_gap(task_.ground, task_.start.surface, budget, wish.max_gap, progress);
    }
    const auto improver = [&](const ImproveOptions& asked,
                              const Progress& share) -> Result<Triangles> {
      runs_.use_one();
      Result<Improved> made = task_.ground.improved(task_.start.surface, asked, share);
      return made ? Result<Triangles>(Triangles{std::move(*made), std::nullopt, std::nullopt})
                  : made.error();
    };
    return improve_without_webs(task_.ground, budget, improver, progress);
  }

  const QuadTask& task_;
  Runs runs_;
  std::vector<std::pair<Wish, Triangles>> known_;
};

/// Triangles, with so many vertices more than there may be, and quads made of them.
Result<QuadStage> paired_quads_of(int more_vertices, const QuadTask& task, bool with_rings,
                                  const QuadOptions& quads, TriangleTries& triangle_tries,
                                  const Progress& progress) {
  const GenerateOptions& options = task.options;
  const auto most = static_cast<std::size_t>(options.faces);
  int triangles = triangles_for(options.faces);
  double gap = options.max_gap;
  std::optional<QuadStage> best;
  for (int k = 0; k < attempts && (k == 0 || triangle_tries.are_left()); ++k) {
    // The first attempt fits unless there is more to keep to than a number of vertices.
    const bool may_fail = options.max_gap > 0 || options.faces > 0;
    const Progress part =
        may_fail ? progress.part(static_cast<double>(k) / attempts, (k + 1.0) / attempts)
                 : progress;
    Result<Triangles> start = triangle_tries.made({triangles, more_vertices, gap, with_rings},
                                                  part.part(0, triangles_made));
    if (!start) {
      return start.error();
    }
    QuadOptions own = quads;
    own.parts = start->improved.parts;
    if (with_rings) {
      own.bands = task.rings.bands;
    }
    Result<Quadrangulated> made =
        make_quads(start->improved.cage, task.ground.surface(), own, part.part(triangles_made, 1));
    if (!made) {
      return made.error();
    }
    QuadStage stage{std::move(start->improved.report), std::move(*made), std::nullopt};
    const std::size_t faces = task.ground.faces_of(stage.made.cage.face_count());
    bool fits = true;
    if (options.max_gap > 0) {
      const double diagonal = task.ground.diagonal();
      const double width = gap_width * options.max_gap * diagonal;
      stage.gap = task.ground.gap_of(stage.made.cage, width) / diagonal;
      fits = *stage.gap <= options.max_gap;
      if (!fits) {
        stage.report.reached = false;
        stage.report.why_not = "the quads are farther from the model than the triangles they were "
                               "made of; allow more vertices, or leave out the quads";
        constexpr double less = 0.95;
        gap = std::max(1.05 * task.start.clearance, less * gap * options.max_gap / *stage.gap);
      }
    }
    if (options.faces > 0 && faces > most) {
      fits = false;
      stage.report.reached = false;
      stage.report.why_not = no_smaller;
      // In the end as few triangles as there may be faces: that is enough.
      const double factor = 0.98 * static_cast<double>(most) / static_cast<double>(faces);
      triangles = k + 2 < attempts ? static_cast<int>(factor * triangles) : options.faces;
    }
    const bool is_nearer =
        !best || (stage.gap && best->gap && *stage.gap < *best->gap) ||
        (options.faces > 0 && faces < task.ground.faces_of(best->made.cage.face_count()));
    if (fits || is_nearer) {
      best = std::move(stage);
    }
    if (fits) {
      break;
    }
  }
  return std::move(*best);
}

/// Triangles, and quads made of them. Quads may have fewer vertices than there may be, as limbs end
/// in faces where the triangles ended in a vertex: then they are made of so many more.
Result<QuadStage> paired_quads(const QuadTask& task, bool with_rings, const QuadOptions& quads,
                               const Judge& judge, TriangleTries& tries, const Progress& progress) {
  constexpr double first = 0.6; // of the time
  constexpr double few = 0.025; // of the vertices: not worth another try
  Result<QuadStage> made =
      paired_quads_of(0, task, with_rings, quads, tries, progress.part(0, first));
  const int most = vertex_limit(task.options);
  if (!made || !made->report.reached || most == 0 || task.options.max_gap > 0 ||
      !tries.are_left()) {
    return made;
  }
  const int left = most - static_cast<int>(task.ground.vertices_of(made->made.cage.positions));
  if (left <= few * most) {
    return made;
  }
  Result<QuadStage> more =
      paired_quads_of(left, task, with_rings, quads, tries, progress.part(first, 1));
  if (!more) {
    return more.error().code == ErrorCode::cancelled ? std::move(more) : std::move(made);
  }
  more->report.reached = more->report.reached && is_within(more->made.cage, task);
  if (!(judge.cost_of(*more) < judge.cost_of(*made))) {
    return made;
  }
  // What they were made of is finer than they are: they are as much better as they are tighter.
  more->report.objective =
      made->report.objective * judge.looseness_of(*more) / judge.looseness_of(*made);
  return more;
}

/// Whether the triangles that the quads were made of, with rings, are much worse than without.
bool rings_cost_much(const QuadTask& task, const QuadStage& with, TriangleTries& tries,
                     const Progress& progress) {
  if (task.options.max_gap > 0 || !tries.are_left()) {
    return false; // with a gap they have other numbers of vertices
  }
  constexpr double much = 1.05; // rings seldom cost more than 3 %
  const Result<Triangles> without =
      tries.made({.faces = triangles_for(task.options.faces)}, progress);
  return without && without->improved.report.reached &&
         with.report.objective > much * without->improved.report.objective;
}

/// Whether the quads cost so much more than the triangles they were made of that others may do
/// better.
bool are_much_dearer(const QuadTask& task, const QuadStage& with, const Judge& judge,
                     TriangleTries& tries) {
  if (task.options.max_gap > 0) {
    return false;
  }
  constexpr double much = 1.3;
  const Result<Triangles> known = // from before
      tries.made({.faces = triangles_for(task.options.faces), .with_rings = true}, {});
  return known && judge.cost_of(*known).times(much) < judge.cost_of(with);
}

/// Whether there are rings that were asked for.
bool are_rings_asked_for(const QuadTask& task) {
  return task.rings.count > 0 && !task.options.joints.empty();
}

/// The same with the rings, or without if they cost much, or do not leave enough vertices, enough
/// quads or round enough faces. Rings that were asked for stay as long as the budget allows.
Result<QuadStage> ringed_quads(const QuadTask& task, const QuadOptions& quads, const Judge& judge,
                               TriangleTries& tries, const Progress& progress) {
  constexpr double usual = 0.8; // of the time
  constexpr double compared = 0.85;
  const bool has_rings = task.rings.count > 0;
  Result<QuadStage> with =
      paired_quads(task, true, quads, judge, tries, progress.part(0, has_rings ? usual : 1));
  if (!with || !has_rings || (are_rings_asked_for(task) && with->report.reached)) {
    return with;
  }
  if (task.is_first && with->report.reached && judge.is_webbed(*with)) {
    return with;
  }
  const bool much = rings_cost_much(task, *with, tries, progress.part(usual, compared)) ||
                    are_much_dearer(task, *with, judge, tries);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  if ((!much && with->report.reached && is_well_shaped(*with)) || !tries.are_left()) {
    return with;
  }
  Result<QuadStage> without =
      paired_quads(task, false, quads, judge, tries, progress.part(compared, 1));
  const bool is_better = without && judge.cost_of(*without) < judge.cost_of(*with);
  return !without || is_better ? std::move(without) : std::move(with);
}

/// The better one of quads made of triangles, and of blocks. Those of blocks are all quads, in
/// strips all round: that is worth a little, but less if the others have rings round limbs.
Result<QuadStage> best_quads(const QuadTask& task, const QuadOptions& quads, const Judge& judge,
                             TriangleTries& tries, const Progress& progress) {
  const GenerateOptions& options = task.options;
  // Of blocks nothing is known about the greatest gap.
  const bool try_blocks = options.max_gap == 0 && vertices_allowed(options) > 0;
  constexpr double paired = 0.5; // of the time
  Result<QuadStage> pairs =
      ringed_quads(task, quads, judge, tries, progress.part(0, try_blocks ? paired : 1));
  if (!pairs || !try_blocks || (are_rings_asked_for(task) && pairs->report.reached)) {
    return pairs; // blocks have no rings but their own
  }
  if (task.is_first && pairs->report.reached && judge.is_webbed(*pairs)) {
    return pairs;
  }
  constexpr double worth = 1.08;
  constexpr double worth_rings = 1.03;
  const std::vector<Index>& parts = pairs->made.parts;
  const bool has_rings =
      std::any_of(parts.begin(), parts.end(), [&](Index part) { return part != parts.front(); });
  const Cost worth_of_pairs = judge.cost_of(*pairs).times(has_rings ? worth_rings : worth);
  constexpr double most_loose = 1.5; // times as much as pairs: then they are dearer in any case
  const bool must_be_better = pairs->report.reached;
  const double loosest = must_be_better ? most_loose * judge.looseness_of(*pairs) : 0;
  const Result<QuadStage> blocks = quads_of_blocks(
      task, quads, loosest, must_be_better ? worth_of_pairs.value : 0, progress.part(paired, 1));
  if (!blocks) {
    return blocks.error().code == ErrorCode::cancelled ? blocks : pairs;
  }
  const bool is_better = judge.cost_of(*blocks) < worth_of_pairs;
  return is_better ? blocks : pairs;
}

/// The best, and where its faces are ill shaped another try with twice the weight on shape.
Result<QuadStage> well_shaped_quads(const QuadTask& task, QuadOptions quads, const Judge& judge,
                                    const Progress& progress) {
  TriangleTries tries(task);
  constexpr double usual = 0.9; // of the time: hardly ever is there another try
  Result<QuadStage> made = best_quads(task, quads, judge, tries, progress.part(0, usual));
  if (!made || !made->report.reached || task.options.max_gap > 0 || is_well_shaped(*made) ||
      !tries.are_left() || (task.is_first && judge.is_webbed(*made))) {
    return made;
  }
  constexpr double dearer = 2;
  quads.shape *= dearer;
  Result<QuadStage> again = paired_quads_of(0, task, true, quads, tries, progress.part(usual, 1));
  const bool is_cancelled = !again && again.error().code == ErrorCode::cancelled;
  return is_cancelled || (again && judge.cost_of(*again) < judge.cost_of(*made)) ? std::move(again)
                                                                                 : std::move(made);
}

} // namespace

Result<QuadStage> make_quads_in_budget(const QuadTask& task, const Progress& progress) {
  const ImproveOptions budget = task.ground.budget(task.start.clearance);
  QuadOptions quads;
  quads.clearance = budget.clearance;
  quads.square = budget.square;
  quads.shape = budget.shape;
  quads.density = budget.density;
  quads.diagonal = task.ground.diagonal();
  const Judge judge(task, quads, progress);
  quads.webbing = [&judge](TriangleView cage) {
    return judge.webbing_of({{cage.positions.begin(), cage.positions.end()},
                             {cage.triangles.begin(), cage.triangles.end()}});
  };
  Result<QuadStage> made = well_shaped_quads(task, quads, judge, progress);
  if (made) {
    judge.put_objective(*made);
  }
  return made;
}

} // namespace cagewright
