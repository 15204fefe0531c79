#include "cage/paired_surface.h"

#include "cage/budget.h"
#include "cage/engine_runs.h"
#include "cage/ground.h"
#include "cage/own_cage.h"
#include "cage/stage_time.h"
#include "cage/start.h"
#include "cage/surface.h"
#include "improve/guard.h"
#include "improve/objective.h"
#include "improve/simplify.h"
#include "symmetry/posed_reflection.h"
#include "symmetry/symmetric_pose.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// Of the surface that tells left from right: hands and feet, no fingers.
constexpr int guide_vertices = 1000;

// Shares of the time.
constexpr double reflected = 0.3;
constexpr double caged = 0.8;

constexpr const char* remedy = "; a plane across an axis can be insisted on";

Error not_paired(std::string why) {
  return {ErrorCode::no_valid_cage, std::move(why) + remedy};
}

/// A closed surface of one piece round the model.
Result<TriangleMesh> guide_of(TriangleView model, const GenerateOptions& options,
                              const Progress& progress) {
  GenerateOptions plain;
  plain.clearance = options.clearance;
  plain.vertices = guide_vertices;
  EngineRuns runs;
  const Ground ground(model, plain, std::nullopt, runs);
  StartTry how;
  how.envelope_vertices = guide_vertices;
  constexpr double started = 0.5; // of the time
  const Result<Start> start = start_from_envelope(ground, plain, how, progress.part(0, started));
  if (!start) {
    return start.error();
  }
  // It need not be tight.
  WorkingCage guide(start->surface);
  const Guard guard(ground.surface(), start->clearance * ground.diagonal());
  ObjectiveWeights weights;
  weights.typical_area = surface_area(start->surface) / (2.0 * guide_vertices);
  const Objective objective(ground.surface(), weights);
  SimplifyOptions simpler;
  simpler.vertices = guide_vertices;
  simpler.placement = Placement::outside_patch;
  if (!simplify(guide, guard, objective, simpler, progress.part(started, 1))) {
    return Error::cancelled();
  }
  return guide.mesh.compact();
}

/// The model in a symmetric pose, and the way back.
struct Straightened {
  TriangleMesh model; ///< about its own mirror image in x = 0
  std::vector<LimbJoint> joints;
  MirrorPlane plane; ///< in the model's coordinates
  TriangleMesh guide;
  std::vector<Vec3> pose;      ///< of the guide, where the straightened model is
  std::vector<Vec3> pose_here; ///< the same in the model's coordinates
};

Result<Straightened> straightened(TriangleView model, const GenerateOptions& options,
                                  std::vector<StageTime>& times, const Progress& progress) {
  constexpr double found = 0.5; // of the time
  constexpr double mapped = 0.9;
  Stopwatch watch(times);
  Result<TriangleMesh> guide = guide_of(model, options, progress.part(0, found));
  if (!guide) {
    return guide.error();
  }
  watch.lap("guide");
  const auto map = find_posed_reflection(*guide, progress.part(found, mapped));
  if (!map) {
    return Error::cancelled();
  }
  if (const std::string why_not = map->why_not(); !why_not.empty()) {
    return not_paired("the model has no left and right that are alike, in whatever pose: " +
                      why_not);
  }
  const MirrorFrame frame(map->plane, bounding_box(model.positions));
  const std::vector<Vec3> pose = symmetric_pose(*guide, *map, frame, progress.part(mapped, 1));
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  const PoseChange change(*guide, pose);
  Straightened result;
  result.plane = map->plane;
  result.model = change(model);
  for (const LimbJoint& joint : options.joints) {
    const Vec3 at = change(joint.position);
    result.joints.push_back({at, change(joint.position + joint.along) - at});
  }
  for (const Vec3& p : pose) {
    result.pose_here.push_back(frame.from_frame(p)[0]);
  }
  result.pose = pose;
  result.guide = std::move(*guide);
  watch.lap("symmetry");
  return result;
}

/// The vertices that are each other's left and right are no longer mirror images.
void take_off_plane(MirrorPairing& mirror, const MirrorPlane& plane, std::span<const Vec3> at) {
  mirror.in_plane = false;
  mirror.plane = plane;
  mirror.error = 0;
  for (std::size_t v = 0; v < at.size(); ++v) {
    mirror.error =
        std::max(mirror.error, (plane.mirrored(at[v]) - at[mirror.vertex_partners[v]]).norm());
  }
}

/// What was asked for of the greatest gap was kept in another pose: here it is measured.
void measure_gap(GeneratedCage& cage, TriangleView model, const GenerateOptions& options) {
  EngineRuns runs;
  const Ground ground(model, options, std::nullopt, runs);
  constexpr double width = 0.02; // of the bound
  const double gap = ground.gap_of(cage.faces, width * options.max_gap * ground.diagonal());
  cage.gap = gap / ground.diagonal();
  drop(cage, Reason::gap_not_kept);
  if (*cage.gap > options.max_gap) {
    add(cage, {Reason::gap_not_kept,
               "in the model's pose the paired cage is farther from the model in places",
               true,
               {}});
  }
}

/// The cage of the symmetric pose carried to the model's, in steps of equal length, and in each
/// laid round the model in that pose.
Result<GeneratedCage> carried(TriangleView model, const GenerateOptions& options, PolygonMesh cage,
                              const Straightened& straight, int steps, const Progress& progress) {
  TriangleMesh guide{straight.pose, straight.guide.triangles};
  for (int step = 1;; ++step) {
    const double share = static_cast<double>(step) / steps;
    std::vector<Vec3> next = straight.guide.positions;
    for (std::size_t v = 0; step < steps && v < next.size(); ++v) {
      next[v] = share * next[v] + (1 - share) * straight.pose_here[v];
    }
    const PoseChange change(guide, next);
    for (Vec3& p : cage.positions) {
      p = change(p);
    }
    guide.positions = std::move(next);
    GenerateOptions fit = options;
    fit.start = &cage;
    const TriangleMesh between =
        step < steps ? PoseChange(straight.guide, guide.positions)(model) : TriangleMesh();
    Result<GeneratedCage> fitted = own_cage(step < steps ? TriangleView(between) : model, fit,
                                            progress.part(share - 1.0 / steps, share));
    if (!fitted || step == steps) {
      return fitted;
    }
    cage.positions = std::move(fitted->faces.positions);
  }
}

/// A mirrored cage of the symmetric pose laid round the model: at one go, or where that does not
/// keep the clearance in steps.
Result<GeneratedCage> laid_round(TriangleView model, const GenerateOptions& options,
                                 GeneratedCage made, const Straightened& straight,
                                 const Progress& progress) {
  constexpr double usual = 0.5; // of the time
  constexpr int steps = 3;
  Result<GeneratedCage> fitted =
      carried(model, options, made.faces, straight, 1, progress.part(0, usual));
  if (!(fitted && fitted->is_as_asked()) && !progress.cancelled()) {
    Result<GeneratedCage> again =
        carried(model, options, made.faces, straight, steps, progress.part(usual, 1));
    if (again && (!fitted || again->is_as_asked())) {
      fitted = std::move(again);
    }
  }
  if (!fitted) {
    return fitted.error().code == ErrorCode::cancelled
               ? fitted.error()
               : not_paired("the paired cage could not be laid round the model in its pose");
  }
  if (fitted->faces.positions.size() != made.faces.positions.size()) {
    return not_paired("the paired cage fell together in the model's pose"); // vertices were welded
  }
  made.faces = std::move(fitted->faces);
  made.triangles = std::move(fitted->triangles);
  made.clearance = std::min(made.clearance, fitted->clearance);
  if (made.quads) {
    made.quads = fitted->quads;
  }
  made.times.insert(made.times.end(), fitted->times.begin(), fitted->times.end());
  take_off_plane(*made.mirror, straight.plane, made.faces.positions);
  for (const Remark& remark : fitted->remarks) {
    add(made, remark);
  }
  if (options.max_gap > 0) {
    measure_gap(made, model, options);
  }
  return made;
}

} // namespace

Result<GeneratedCage> paired_surface(TriangleView model, const GenerateOptions& options,
                                     const Progress& progress) {
  std::vector<StageTime> times;
  const Result<Straightened> straight =
      straightened(model, options, times, progress.part(0, reflected));
  if (!straight) {
    return straight.error();
  }
  GenerateOptions own = options;
  own.joints = straight->joints;
  const Mirroring mirroring{MirrorPlane(), true, ""};
  Result<GeneratedCage> made =
      make_surface(straight->model, own, mirroring, progress.part(reflected, caged));
  if (!made) {
    return made.error();
  }
  if (!made->mirror) {
    return not_paired("in a symmetric pose no cage was found that is its own mirror image");
  }
  made->times.insert(made->times.begin(), times.begin(), times.end());
  return laid_round(model, options, std::move(*made), *straight, progress.part(caged, 1));
}

} // namespace cagewright
