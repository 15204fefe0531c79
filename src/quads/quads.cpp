#include "quads/quads.h"

#include "core/parallel.h"
#include "mesh/shape_limits.h"
#include "quads/edge_loops.h"
#include "quads/limb_caps.h"
#include "quads/matching.h"
#include "quads/pairing.h"
#include "quads/quad_merit.h"
#include "quads/quad_weights.h"
#include "quads/relax_quads.h"
#include "quads/retile.h"
#include "quads/settle_shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

namespace cagewright {
namespace {

TriangleMesh cut(const QuadCage& cage) {
  TriangleMesh mesh{cage.positions(), {}};
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (cage.has_face(f)) {
      const FaceParts parts(cage.face(f));
      for (int k = 0; k < std::min(2, parts.count); ++k) {
        mesh.triangles.push_back(parts.triangles[k]);
      }
    }
  }
  return mesh;
}

bool border_is_in_plane(const QuadCage& cage) {
  for (Index v = 0; v < cage.vertex_end(); ++v) {
    if (cage.on_border(v) && cage.positions()[v].x() != 0) {
      return false;
    }
  }
  return true;
}

// How far beyond the limits quads may be at first.
constexpr double wide_bend = 30; // degrees more
constexpr double wide_least_angle = 5;
constexpr double wide_angle = 175;

/// What quads are made with.
struct Setting {
  const ModelSurface& surface;
  const Objective& objective;
  const QuadOptions& options;

  [[nodiscard]] QuadGuard strict() const {
    return {surface, options.clearance * surface.diagonal, options.limits};
  }
};

/// One way to go about it.
struct Way {
  double room = 1;   ///< how far the cage moves off the model meanwhile, in what the options say
  double lone = 4;   ///< what a triangle costs: see FaceWishes
  bool caps = false; ///< limbs end in a face where they ended in triangles
  /// By what a step may raise the objective for room that there should be already: where there is
  /// none to be had the cage is creased ever more, but some faces find their quads only by that.
  double most_rise = std::numeric_limits<double>::infinity();
};

/// Pairs and tiles the faces of a cage that has room, and moves its vertices, in rounds from much
/// room and wide limits to none and those asked for.
QuadCage with_quads(QuadCage cage, const Setting& setting, const Way& way,
                    const Progress& progress) {
  const QuadOptions& options = setting.options;
  const DirectionField field(cut(cage));
  const double clearance = options.clearance * setting.surface.diagonal;
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    const Progress part =
        progress.part(static_cast<double>(round) / rounds, (round + 1.0) / rounds);
    const bool is_last = round == rounds - 1;
    const double slack = std::max(0.0, 1 - round / (rounds - 2.0));
    QuadLimits limits = options.limits;
    limits.max_bend_degrees += slack * wide_bend;
    limits.min_angle_degrees += slack * (wide_least_angle - limits.min_angle_degrees);
    limits.max_angle_degrees += slack * (wide_angle - limits.max_angle_degrees);
    const QuadGuard guard(setting.surface, clearance, limits);
    Taste taste;
    taste.wishes.limits = limits;
    taste.wishes.lone = way.lone;
    taste.wishes.beyond = is_last ? 0 : 60;
    const bool may_cap = way.caps && round >= rounds - 2;
    if (is_last || may_cap) {
      split_unfit(cage, limits);
    }
    if (may_cap) {
      cap_limbs(cage, guard, wide_bend);
    }
    cage.renumber_faces();
    KnownClear known;
    const QuadGuard still = guard.while_still(known);
    pair_triangles(cage, still, field, taste);
    retile(cage, still, field, taste, part.part(0, 0.5));
    cage.renumber_faces();
    RelaxQuadsOptions settle;
    settle.keep = options.clearance + slack * way.room * options.room;
    settle.steps = is_last ? 24 : 4;
    if (round > 0) {
      settle.most_rise = way.most_rise;
    }
    relax_quads(cage, guard, setting.objective, settle, part.part(0.5, 1));
  }
  split_unfit(cage, options.limits);
  return cage;
}

/// Quads made one way, as round as pays.
QuadCage quads_made(QuadCage cage, const Setting& setting, const Way& way,
                    const Progress& progress) {
  const QuadGuard strict = setting.strict();
  const double clearance = setting.options.clearance;
  relax_quads(cage, strict, setting.objective,
              {.steps = 3, .keep = clearance + way.room * setting.options.room},
              progress.part(0, 0.1));
  cage = with_quads(std::move(cage), setting, way, progress.part(0.1, 0.95));
  settle_shapes(cage, strict, setting.objective, {.keep = clearance}, progress.part(0.95, 1));
  return cage;
}

double objective_of(QuadCage cage, const Setting& setting) {
  return relax_quads(cage, setting.strict(), setting.objective, {.steps = 0});
}

/// What a cage of quads costs: the objective, times what webs and ill shaped faces add, and for
/// each vertex: those that are saved can be spent elsewhere.
double cost_of(const QuadCage& cage, const Setting& setting) {
  const PolygonMesh faces = cage.to_polygons();
  const double webbing =
      setting.options.webbing ? setting.options.webbing(to_triangle_mesh(faces)) : 0;
  return objective_of(cage, setting) * (1 + webbing) *
         dearer_by_shapes(report_of(faces), shape_limits::wanted_quads) *
         static_cast<double>(faces.positions.size()) / static_cast<double>(cage.vertex_end());
}

/// The cheapest of several tries. With much room quads get better shapes, and thin limbs that are
/// near each other grow together; where triangles are dear there are fewer of them, and quads that
/// need more bending; limbs that end in a face have fewer triangles, and those that end in a point
/// are tighter. Which is better for a model shows only when it is done. Two at least are made, side
/// by side; more while the best is not much like what it was made of; of large cages fewer. What
/// has fewer quads than triangles is taken only if all have.
QuadCage best_of_ways(const QuadCage& start, const Setting& setting, const Progress& progress) {
  constexpr std::array ways = {Way{0.6, 4, true}, Way{0.4, 4}, Way{0.6, 8, true, 0.05},
                               Way{1, 12, false, 0.05}};
  constexpr std::size_t at_once = 2;
  constexpr std::size_t most_faces = 1200; // of all tries together
  constexpr double good_enough = 1.2;      // times what the triangles cost
  constexpr double few = 0.5;
  const std::size_t most = std::clamp<std::size_t>(most_faces / start.face_end(), 1, ways.size());
  const double enough = good_enough * objective_of(start, setting);
  QuadCage best = start;
  using Price = std::pair<bool, double>; // whether there are few quads; what it costs
  Price least{true, std::numeric_limits<double>::infinity()};
  for (std::size_t done = 0;
       done < most && least > Price{false, enough} && !progress.cancelled();) {
    const std::size_t then = std::min(done + at_once, most);
    const auto share = [&](std::size_t tries) {
      return static_cast<double>(tries) / static_cast<double>(most);
    };
    progress(share(done), "make quads");
    std::vector<QuadCage> made(then - done, start);
    std::vector<Price> prices(then - done);
    const Progress quiet = progress.quiet();
    parallel_for(0, made.size(), 1, quiet, [&](std::size_t i) {
      made[i] = quads_made(start, setting, ways[done + i],
                           made.size() > 1 ? quiet : progress.part(share(done), share(then)));
      prices[i] = {report_of(made[i].to_polygons()).share < few, cost_of(made[i], setting)};
    });
    if (progress.cancelled()) {
      break; // what was made last is not to be used
    }
    for (std::size_t i = 0; i < made.size(); ++i) {
      if (prices[i] < least) {
        least = prices[i];
        best = std::move(made[i]);
      }
    }
    done = then;
  }
  return best;
}

/// Each quad begins at a corner of its shorter diagonal.
void turn_quads(QuadCage& cage) {
  std::vector<Index> removed;
  std::vector<CageFace> added;
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (cage.has_face(f)) {
      removed.push_back(f);
      added.push_back(along_shorter_diagonal(cage.positions(), cage.face(f)));
    }
  }
  cage.replace(removed, added);
}

/// Fills in what the report says of the triangles' shapes.
void report_shapes(TriangleView mesh, QuadReport& report) {
  std::size_t count = 0;
  report.least_quality = mesh.triangles.empty() ? 0 : 1;
  for (const Triangle& t : mesh.triangles) {
    const double quality =
        triangle_quality(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    count += quality < shape_limits::thin ? 1 : 0;
    report.least_quality = std::min(report.least_quality, quality);
  }
  report.thin = mesh.triangles.empty()
                    ? 0
                    : static_cast<double>(count) / static_cast<double>(mesh.triangles.size());
}

} // namespace

QuadReport report_of(const PolygonMesh& mesh) {
  QuadReport report;
  report.min_angle_degrees = 360;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> v = mesh.face(f);
    if (v.size() != 4) {
      report.triangles += v.size() == 3 ? 1 : 0;
      continue;
    }
    ++report.quads;
    const QuadShape shape = shape_of(
        {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]});
    report.max_bend_degrees = std::max(report.max_bend_degrees, shape.bend_degrees);
    report.max_angle_degrees = std::max(report.max_angle_degrees, shape.max_angle_degrees);
    report.min_angle_degrees = std::min(report.min_angle_degrees, shape.min_angle_degrees);
  }
  const std::size_t faces = mesh.face_count();
  report.share = faces > 0 ? static_cast<double>(report.quads) / static_cast<double>(faces) : 0;
  report_shapes(to_triangle_mesh(mesh), report);
  report.rings = closed_strips(mesh);
  report.loops = closed_loops(mesh);
  return report;
}

Result<Quadrangulated> make_quads(TriangleView start, TriangleView model,
                                  const QuadOptions& options, const Progress& progress) {
  if (model.positions.empty()) {
    return Error{ErrorCode::unfit_model, "the model has no vertices"};
  }
  return make_quads(start, ModelSurface(model, options.diagonal), options, progress);
}

Result<Quadrangulated> make_quads(TriangleView start, const ModelSurface& surface,
                                  const QuadOptions& options, const Progress& progress) {
  const TriangleView model = surface.mesh;
  if (start.triangles.empty()) {
    return Error{ErrorCode::invalid_cage, "the cage to make quads of has no faces"};
  }
  if (model.positions.empty()) {
    return Error{ErrorCode::unfit_model, "the model has no vertices"};
  }
  if (!(options.clearance > 0 && options.clearance < 1) || !(options.room >= 0)) {
    return Error{ErrorCode::invalid_option, "an option of the quads is out of its range"};
  }
  if (!options.density.empty() && options.density.size() != model.positions.size()) {
    return Error{ErrorCode::invalid_option, "there must be one density for each model vertex"};
  }
  if (!options.parts.empty() && options.parts.size() != start.triangles.size()) {
    return Error{ErrorCode::invalid_option, "there must be one part for each face"};
  }
  QuadCage cage(start, options.parts, options.bands);
  if (!border_is_in_plane(cage)) {
    return Error{ErrorCode::invalid_cage, "the cage to make quads of is open"};
  }
  const double face_area = surface_area(start) / static_cast<double>(start.triangles.size());
  const Objective objective(surface, weights_for(model, options, face_area));
  cage = best_of_ways(cage, {surface, objective, options}, progress);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  turn_quads(cage);
  Quadrangulated result;
  result.cage = cage.to_polygons();
  result.parts = cage.parts();
  result.report = report_of(result.cage);
  return result;
}

PolygonMesh pair_coplanar(TriangleView mesh) {
  QuadCage cage(mesh);
  FaceWishes wishes;
  wishes.limits = {.max_bend_degrees = 0.1, .min_angle_degrees = 5, .max_angle_degrees = 175};
  std::vector<PossiblePair> possible;
  std::vector<CageFace> quads;
  for (const PairOfTriangles& pair : neighboring_triangles(cage)) {
    const double defect = face_defect(cage.positions(), pair.quad, wishes);
    if (defect < unfit) {
      possible.push_back({pair.left, pair.right, defect});
      quads.push_back(pair.quad);
    }
  }
  for (const std::size_t i : most_pairs(cage.face_end(), possible)) {
    cage.replace(std::array{possible[i].first, possible[i].second}, std::array{quads[i]});
  }
  turn_quads(cage);
  return cage.to_polygons();
}

} // namespace cagewright
