#include "cage/quad_stage.h"

#include "cage/budget_start.h"
#include "quads/grid_quads.h"
#include "validate/greatest_gap.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/webbing.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cagewright {
namespace {

constexpr int attempts = 4;
constexpr double triangles_made = 0.4;  // of the time of an attempt
constexpr double usual_triangles = 1.8; // that one face comes from
constexpr double gap_width = 0.002;     // of the greatest gap: how well it is bounded

std::size_t sides_of(const ImproveOptions& budget) {
  return budget.extent == CageExtent::half ? 2 : 1;
}

bool is_within(const PolygonMesh& cage, const ImproveOptions& budget) {
  std::size_t on_plane = 0;
  for (const Vec3& p : cage.positions) {
    on_plane += budget.extent == CageExtent::half && p.x() == 0 ? 1 : 0;
  }
  const std::size_t vertices = sides_of(budget) * cage.positions.size() - on_plane;
  const std::size_t faces = sides_of(budget) * cage.face_count();
  return (budget.vertices == 0 || vertices <= static_cast<std::size_t>(budget.vertices)) &&
         (budget.faces == 0 || faces <= static_cast<std::size_t>(budget.faces));
}

/// All quads cut along their first diagonal, or along their second.
TriangleMesh cut(const PolygonMesh& mesh, std::size_t diagonal) {
  TriangleMesh result{mesh.positions, {}};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    const std::size_t k = face.size() == 4 ? diagonal : 0;
    result.triangles.push_back({face[k], face[k + 1], face[k + 2]});
    if (face.size() == 4) {
      result.triangles.push_back({face[k], face[k + 2], face[(k + 3) % 4]});
    }
  }
  return result;
}

/// A cage of blocks, as tight as it gets.
Result<QuadStage> quads_of_blocks(TriangleView model, const QuadOptions& quads,
                                  const ImproveOptions& budget, double loosest,
                                  const Progress& progress) {
  // The exchange of loops makes a cage of blocks tighter by so much, and not by more.
  constexpr double gain = 3;
  GridQuadOptions options;
  options.loosest = gain * loosest;
  options.quads = quads;
  options.vertices = budget.vertices;
  options.faces = budget.faces;
  options.half = budget.extent == CageExtent::half;
  Result<Quadrangulated> made = make_grid_quads(model, options, progress);
  if (!made) {
    return made.error();
  }
  QuadStage stage{{}, std::move(*made), std::nullopt};
  stage.report.reached = is_within(stage.made.cage, budget);
  return stage;
}

/// Whether enough faces are quads, and round. There may be a needle.
bool is_mostly_good(const QuadReport& quads) {
  return quads.share >= enough_quads && quads.thin <= few_thin;
}

bool is_well_shaped(const QuadReport& quads) {
  return is_mostly_good(quads) && quads.least_quality >= needle;
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

/// What a cage costs: whether it is beyond the budget, and then its volume and what there is
/// between it and the model, times what webs and ill shaped faces add. Less is better.
using Cost = std::pair<bool, double>;

class Judge {
public:
  Judge(const QuadTask& task, const QuadOptions& quads)
      : extent_(task.budget.extent), quads_(quads), all_(with_strays(task.model)),
        surface_(all_, task.diagonal),
        between_(extent_ == CageExtent::half ? whole_of(all_) : all_) {}

  [[nodiscard]] double looseness_of(const QuadStage& stage) const {
    return looseness(stage.made.cage, surface_, all_, quads_);
  }

  [[nodiscard]] Cost cost_of(const QuadStage& stage) const {
    const TriangleMesh cage = to_triangle_mesh(stage.made.cage);
    const double webbing =
        between_.share_inside(extent_ == CageExtent::half ? whole_of(cage) : cage);
    const QuadReport& report = stage.made.report;
    constexpr double of_shapes = 2;
    constexpr double for_needles = 0.1;
    const double shapes = of_shapes * (std::max(0.0, enough_quads - report.share) +
                                       std::max(0.0, report.thin - few_thin)) +
                          (report.least_quality < needle ? for_needles : 0);
    return {!stage.report.reached, (volume_of(stage.made.cage, extent_) + looseness_of(stage)) *
                                       (1 + webbing) * (1 + shapes)};
  }

private:
  CageExtent extent_;
  QuadOptions quads_;
  TriangleMesh all_;
  ModelSurface surface_;
  SpaceBetween between_;
};

/// How many triangles are made for so many faces, to begin with.
int triangles_for(int faces) {
  return static_cast<int>(std::lround(usual_triangles * faces));
}

/// Triangles, and quads made of them.
Result<QuadStage> paired_quads(const QuadTask& task, const LimbRings& rings,
                               const QuadOptions& quads, const Progress& progress) {
  const BudgetCageOptions& options = task.options;
  const ImproveOptions& budget = task.budget;
  const double diagonal = quads.diagonal;
  const std::size_t sides = sides_of(budget);
  const auto most = static_cast<std::size_t>(budget.faces);
  int triangles = triangles_for(budget.faces);
  double gap = options.max_gap;
  std::optional<QuadStage> best;
  for (int k = 0; k < attempts; ++k) {
    // The first attempt fits unless there is more to keep to than a number of vertices.
    const bool may_fail = options.max_gap > 0 || budget.faces > 0;
    const Progress part =
        may_fail ? progress.part(static_cast<double>(k) / attempts, (k + 1.0) / attempts)
                 : progress;
    Result<Improved> start =
        task.make_triangles(triangles, gap, rings, part.part(0, triangles_made));
    if (!start) {
      return start.error();
    }
    QuadOptions own = quads;
    own.parts = start->parts;
    own.bands = rings.bands;
    Result<Quadrangulated> made =
        make_quads(start->cage, task.model, own, part.part(triangles_made, 1));
    if (!made) {
      return made.error();
    }
    QuadStage stage{std::move(start->report), std::move(*made), std::nullopt};
    const std::size_t faces = sides * stage.made.cage.face_count();
    bool fits = true;
    if (options.max_gap > 0) {
      const double width = gap_width * options.max_gap * diagonal;
      stage.gap = task.gap_of(stage.made.cage, width) / diagonal;
      fits = *stage.gap <= options.max_gap;
      if (!fits) {
        stage.report.reached = false;
        stage.report.why_not = "the quads are farther from the model than the triangles they were "
                               "made of; allow more vertices, or leave out the quads";
        constexpr double less = 0.95;
        gap = std::max(1.05 * budget.clearance, less * gap * options.max_gap / *stage.gap);
      }
    }
    if (budget.faces > 0 && faces > most) {
      fits = false;
      stage.report.reached = false;
      stage.report.why_not = "no smaller cage of quads was found";
      // In the end as few triangles as there may be faces: that is enough.
      const double factor = 0.98 * static_cast<double>(most) / static_cast<double>(faces);
      triangles = k + 2 < attempts ? static_cast<int>(factor * triangles) : budget.faces;
    }
    const bool is_nearer = !best || (stage.gap && best->gap && *stage.gap < *best->gap) ||
                           (budget.faces > 0 && faces < sides * best->made.cage.face_count());
    if (fits || is_nearer) {
      best = std::move(stage);
    }
    if (fits) {
      break;
    }
  }
  return std::move(*best);
}

/// Whether the triangles that the quads were made of, with rings, are much worse than without.
bool rings_cost_much(const QuadTask& task, const QuadStage& with, const Progress& progress) {
  if (task.options.max_gap > 0) {
    return false; // then they have other numbers of vertices
  }
  constexpr double much = 1.05; // rings seldom cost more than 3 %
  const Result<Improved> without =
      task.make_triangles(triangles_for(task.budget.faces), 0, {}, progress);
  return without && without->report.reached &&
         with.report.objective > much * without->report.objective;
}

/// The same with the rings, or without if they cost much, or do not leave enough vertices, enough
/// quads or round enough faces.
Result<QuadStage> ringed_quads(const QuadTask& task, const QuadOptions& quads, const Judge& judge,
                               const Progress& progress) {
  constexpr double usual = 0.8; // of the time
  constexpr double compared = 0.85;
  Result<QuadStage> with = paired_quads(task, task.rings, quads, progress.part(0, usual));
  if (!with || task.rings.count == 0) {
    return with;
  }
  const bool much = rings_cost_much(task, *with, progress.part(usual, compared));
  if (!much && with->report.reached && is_well_shaped(with->made.report)) {
    return with;
  }
  Result<QuadStage> without = paired_quads(task, {}, quads, progress.part(compared, 1));
  const bool is_better = without && judge.cost_of(*without) < judge.cost_of(*with);
  return !without || is_better ? std::move(without) : std::move(with);
}

/// The better one of quads made of triangles, and of blocks. Those of blocks are all quads, in
/// strips all round: that is worth a little, but less if the others have rings round limbs.
Result<QuadStage> best_quads(const QuadTask& task, const QuadOptions& quads, const Judge& judge,
                             const Progress& progress) {
  const BudgetCageOptions& options = task.options;
  const ImproveOptions& budget = task.budget;
  // Of blocks nothing is known about the greatest gap.
  const bool try_blocks = options.max_gap == 0 && (budget.vertices > 0 || budget.faces > 0);
  constexpr double paired = 0.5; // of the time
  Result<QuadStage> pairs =
      ringed_quads(task, quads, judge, progress.part(0, try_blocks ? paired : 1));
  if (!pairs || !try_blocks) {
    return pairs;
  }
  constexpr double most_loose = 1.5; // times as much as pairs: then they are dearer in any case
  const double loosest = pairs->report.reached ? most_loose * judge.looseness_of(*pairs) : 0;
  const Result<QuadStage> blocks =
      quads_of_blocks(task.model, quads, budget, loosest, progress.part(paired, 1));
  if (!blocks) {
    return blocks.error().code == ErrorCode::cancelled ? blocks : pairs;
  }
  const auto [over, cost] = judge.cost_of(*pairs);
  constexpr double worth = 1.08;
  constexpr double worth_rings = 1.03;
  const std::vector<Index>& parts = pairs->made.parts;
  const bool has_rings =
      std::any_of(parts.begin(), parts.end(), [&](Index part) { return part != parts.front(); });
  const bool is_better =
      judge.cost_of(*blocks) < Cost{over, cost * (has_rings ? worth_rings : worth)};
  return is_better ? blocks : pairs;
}

} // namespace

double greatest_gap_of_quads(const PolygonMesh& cage, const TriangleBvh& model, double tolerance) {
  return std::max(greatest_gap(cut(cage, 0), model, tolerance).upper,
                  greatest_gap(cut(cage, 1), model, tolerance).upper);
}

Result<QuadStage> make_quads_in_budget(const QuadTask& task, const Progress& progress) {
  const BudgetCageOptions& options = task.options;
  const ImproveOptions& budget = task.budget;
  QuadOptions quads = options.quad_options;
  quads.clearance = budget.clearance;
  quads.square = budget.square;
  quads.shape = budget.shape;
  quads.density = budget.density;
  quads.diagonal = task.diagonal;
  const Judge judge(task, quads);
  constexpr double usual = 0.9; // of the time: hardly ever is there another try
  Result<QuadStage> made = best_quads(task, quads, judge, progress.part(0, usual));
  if (!made || !made->report.reached || options.max_gap > 0 || is_well_shaped(made->made.report)) {
    return made;
  }
  constexpr double dearer = 2;
  quads.shape *= dearer;
  Result<QuadStage> again = paired_quads(task, task.rings, quads, progress.part(usual, 1));
  const bool is_cancelled = !again && again.error().code == ErrorCode::cancelled;
  return is_cancelled || (again && judge.cost_of(*again) < judge.cost_of(*made)) ? std::move(again)
                                                                                 : std::move(made);
}

} // namespace cagewright
