#include "quads/quads.h"

#include "mesh/shape_limits.h"
#include "quads/edge_loops.h"
#include "quads/matching.h"
#include "quads/pairing.h"
#include "quads/quad_weights.h"
#include "quads/relax_quads.h"
#include "quads/retile.h"
#include "quads/settle_shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
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
  double room = 1; ///< how far the cage moves off the model meanwhile, in what the options say

  [[nodiscard]] QuadGuard strict() const {
    return {surface, options.clearance * surface.diagonal, options.limits};
  }
};

/// Pairs and tiles the faces of a cage that has room, and moves its vertices, in rounds from much
/// room and wide limits to none and those asked for.
///
/// \param lone  what a triangle costs: see FaceWishes
QuadCage with_quads(QuadCage cage, const Setting& setting, double lone, const Progress& progress) {
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
    taste.wishes.lone = lone;
    taste.wishes.beyond = is_last ? 0 : 60;
    if (is_last) {
      split_unfit(cage, limits);
    }
    cage.renumber_faces();
    pair_triangles(cage, guard, field, taste);
    retile(cage, guard, field, taste, part.part(0, 0.5));
    cage.renumber_faces();
    RelaxQuadsOptions settle;
    settle.keep = options.clearance + slack * setting.room * options.room;
    settle.steps = is_last ? 8 : 4;
    relax_quads(cage, guard, setting.objective, settle, part.part(0.5, 1));
  }
  split_unfit(cage, options.limits);
  return cage;
}

/// The first of several tries that has enough quads, each with triangles dearer than in the last:
/// there are fewer of them then, and quads that need more bending. If none has, the one with most.
QuadCage with_enough_quads(const QuadCage& roomy, const Setting& setting,
                           std::span<const double> lone, const Progress& progress) {
  QuadCage best = roomy;
  double most = -1;
  double done = 0;
  for (std::size_t i = 0;
       i < lone.size() && most < shape_limits::enough_quads && !progress.cancelled(); ++i) {
    const double then = i == 0 ? 0.7 : (done + 1) / 2; // more tries are seldom needed
    QuadCage cage = with_quads(roomy, setting, lone[i], progress.part(done, then));
    done = then;
    const double share = report_of(cage.to_polygons()).share;
    if (share > most) {
      most = share;
      best = std::move(cage);
    }
  }
  return best;
}

constexpr std::array triangles_dearer = {4.0, 6.0, 8.0, 12.0}; // from try to try

/// Quads made with the setting's room, in so many tries at most, as round as they get.
QuadCage quads_with_room(QuadCage cage, const Setting& setting, std::size_t tries,
                         const Progress& progress) {
  const QuadGuard strict = setting.strict();
  const double clearance = setting.options.clearance;
  relax_quads(cage, strict, setting.objective,
              {.steps = 3, .keep = clearance + setting.room * setting.options.room},
              progress.part(0, 0.1));
  cage = with_enough_quads(cage, setting, std::span(triangles_dearer).first(tries),
                           progress.part(0.1, 0.95));
  settle_shapes(cage, strict, setting.objective, {.keep = clearance}, progress.part(0.95, 1));
  return cage;
}

double objective_of(QuadCage cage, const Setting& setting) {
  return relax_quads(cage, setting.strict(), setting.objective, {.steps = 0});
}

/// What a cage of quads costs: too few of them are worse than a cage that is a little looser.
double cost_of(const QuadCage& cage, const Setting& setting) {
  constexpr double at_once = 0.15;
  constexpr double by_share = 2;
  const double missing = shape_limits::enough_quads - report_of(cage.to_polygons()).share;
  return objective_of(cage, setting) * (1 + (missing > 0 ? at_once + by_share * missing : 0));
}

/// Quads with all the room that the options give, which leads to the best shapes. Where they come
/// out much looser than the triangles they were made of, thin limbs grew together in so much room:
/// then the cheapest of these and of quads made nearer to the model.
QuadCage best_of_rooms(const QuadCage& start, const Setting& setting, const Progress& progress) {
  constexpr double much_looser = 1.25;
  constexpr double usual = 0.8; // of the time: seldom are there other rooms
  constexpr std::array less_room = {0.6, 0.3};
  QuadCage best = quads_with_room(start, setting, triangles_dearer.size(), progress.part(0, usual));
  if (objective_of(best, setting) <= much_looser * objective_of(start, setting)) {
    return best;
  }
  double least = cost_of(best, setting);
  double done = usual;
  for (const double room : less_room) {
    const double then = (done + 1) / 2;
    Setting nearer = setting;
    nearer.room = room;
    QuadCage cage = quads_with_room(start, nearer, 1, progress.part(done, then));
    done = then;
    if (progress.cancelled()) {
      break;
    }
    if (const double cost = cost_of(cage, setting); cost < least) {
      least = cost;
      best = std::move(cage);
    }
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
      added.push_back(cage.face(f));
      CageFace& face = added.back();
      const auto length = [&](int i) {
        return (cage.positions()[face[i]] - cage.positions()[face[i + 2]]).squaredNorm();
      };
      if (face.is_quad() && length(1) < length(0)) {
        face = face.turned(1);
      }
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
  cage = best_of_rooms(cage, {surface, objective, options}, progress);
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
