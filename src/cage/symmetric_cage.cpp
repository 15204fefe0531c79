#include "cage/symmetric_cage.h"

#include "cage/budget_start.h"
#include "cage/improve_to_gap.h"
#include "cage/limb_rings.h"
#include "cage/not_valid.h"
#include "cage/quad_stage.h"
#include "cage/well_shaped.h"
#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// Shares of the whole time, for the progress bar.
constexpr double started = 0.15;
constexpr double improved = 0.95;
constexpr double limbs_found = 0.05; // of the improvement

/// Of the diagonal: a model this near to its mirror image is enclosed with it by any box.
constexpr double same = 1e-6;

/// Of the diagonal. A model further off its mirror image, in the mean, is mirrored only if that is
/// insisted on: a cage round both is looser by about half of it.
constexpr double nearly = 0.001;

/// What is known before the first vertex of the cage is.
struct Task {
  TriangleView model;
  MirrorFrame frame;
  HalfModel half;      ///< what half the cage must enclose
  double diagonal = 0; ///< of the model: what all lengths are fractions of
};

constexpr const char* remedy = "try another resolution, or --symmetry off";

/// The model and its mirror image as one, unless they are the same.
TriangleMesh with_image(const Task& task) {
  TriangleMesh model{{task.model.positions.begin(), task.model.positions.end()},
                     {task.model.triangles.begin(), task.model.triangles.end()}};
  return task.frame.plane().high_error < same
             ? model
             : joined(model, mirror_image(task.model, task.frame.plane()));
}

Result<TriangleMesh> half_of_boxes(const Task& task, const BudgetCageOptions& options,
                                   BudgetCage& made, const Progress& progress) {
  BoxCageOptions generate = options.boxes;
  generate.boxes.clearance = options.improve.clearance;
  Result<BoxCage> boxes = make_box_cage(with_image(task), generate, progress);
  if (!boxes) {
    return boxes.error();
  }
  std::optional<TriangleMesh> half = cut_half(in_frame(boxes->cage, task.frame));
  const Error no_start{ErrorCode::no_valid_cage,
                       "the union of the boxes cut by the mirror plane is no valid cage"};
  if (!half) {
    return no_start;
  }
  const Result<ValidityReport> validity = validate_cage(join_halves(*half, task.frame).mesh,
                                                        task.model, {.first_only = true}, progress);
  if (!validity) {
    return validity.error();
  }
  const double least = mesh_distance(TriangleBvh(*half), TriangleBvh(task.half.mesh)).distance;
  if (!validity->valid() || !(least > 0)) {
    return no_start;
  }
  made.boxes = std::move(*boxes);
  // Boxes may come nearer than the clearance. No step of the improvement comes nearer still.
  constexpr double below = 0.99;
  made.clearance = std::min(options.improve.clearance, below * least / task.diagonal);
  return std::move(*half);
}

Result<TriangleMesh> half_envelope(const Task& task, const BudgetCageOptions& options,
                                   BudgetCage& made, const Progress& progress) {
  return start_from_envelope(in_frame(task.model, task.frame), options, CageExtent::half,
                             task.diagonal, made, progress);
}

Result<TriangleMesh> half_start(const Task& task, const BudgetCageOptions& options,
                                BudgetCage& made, const Progress& progress) {
  if (options.start == CageStart::envelope) {
    return half_envelope(task, options, made, progress);
  }
  Result<TriangleMesh> half = half_of_boxes(task, options, made, progress.part(0, 0.7));
  if (half || half.error().code == ErrorCode::cancelled) {
    return half;
  }
  made.why_not_boxes = half.error().message;
  return half_envelope(task, options, made, progress.part(0.7, 1));
}

/// Half a cage within the budget, or within the gap if one is asked for.
Result<Improved> improve_half(const TriangleMesh& start, const Task& task, double max_gap,
                              const ImproveOptions& improvement, BudgetCage& made,
                              const Progress& progress) {
  if (!(max_gap > 0)) {
    return improve(start, task.half.mesh, improvement, progress);
  }
  // The half keeps near the model and its mirror image. What counts is the model alone.
  const TriangleBvh model(task.model);
  const MeasureGap measure = [&](const TriangleMesh& half, double tolerance) {
    return greatest_gap(join_halves(half, task.frame).mesh, model, tolerance);
  };
  Result<ImprovedToGap> result =
      improve_to_gap(start, task.half.mesh, improvement, max_gap, measure, progress);
  if (!result) {
    return result.error();
  }
  made.gap = result->gap;
  return std::move(result->improved);
}

} // namespace

ChosenPlane choose_mirror_plane(TriangleView model, const BudgetCageOptions& options,
                                const Progress& progress) {
  const Symmetry symmetry = options.symmetry;
  switch (symmetry) {
  case Symmetry::off:
    return {};
  case Symmetry::automatic:
    if (const auto plane = detect_mirror_plane(model, {.origin = options.origin}, progress)) {
      if (plane->mean_error <= nearly) {
        return {plane, ""};
      }
      return {std::nullopt, "the model is only roughly its own mirror image, and a cage round both "
                            "would be looser"};
    }
    return {std::nullopt, "the model is not its own mirror image in any plane"};
  case Symmetry::x:
  case Symmetry::y:
  case Symmetry::z:
    break;
  }
  const int axis = symmetry == Symmetry::x ? 0 : symmetry == Symmetry::y ? 1 : 2;
  if (const auto plane = best_mirror_plane(model, axis, options.origin)) {
    return {plane, ""};
  }
  return {std::nullopt, "the model has no surface to mirror"};
}

Result<BudgetCage> make_symmetric_cage(TriangleView model, const MirrorPlane& plane,
                                       const BudgetCageOptions& options, const Progress& progress) {
  BudgetCage made;
  Stopwatch watch(made.times);
  Task task;
  task.model = model;
  task.frame = MirrorFrame(plane, bounding_box(model.positions));
  task.half = half_model(model, task.frame);
  task.diagonal = diagonal(model.positions);
  const Result<TriangleMesh> start = half_start(task, options, made, progress.part(0, started));
  if (!start) {
    return start.error();
  }
  made.start_vertices = whole_vertices(start->positions, CageExtent::half);
  watch.lap(made.boxes ? "boxes" : "envelope");

  ImproveOptions improvement = options.improve;
  improvement.clearance = made.clearance;
  improvement.extent = CageExtent::half;
  improvement.diagonal = task.diagonal;
  std::vector<double> density;
  if (improvement.density.size() == model.positions.size()) {
    for (const Index v : task.half.vertices) {
      density.push_back(improvement.density[v]);
    }
    improvement.density = density;
  }
  const Progress improving = progress.part(started, improved);
  const Progress checking = progress.part(improved, 1);
  // What is done to the faces of the half is done to both.
  Result<ValidityReport> validity = ValidityReport();
  if (options.quads) {
    const TriangleMesh whole_model = in_frame(model, task.frame);
    const LimbRings all_rings = find_limb_rings(*start, whole_model, vertices_of(improvement),
                                                improving.part(0, limbs_found));
    watch.lap("limbs");
    const MakeTriangles triangles = [&](int faces, double max_gap, const LimbRings& rings,
                                        const Progress& part) {
      ImproveOptions own = improvement;
      own.faces = faces;
      own.parts = rings.parts;
      own.bands = rings.bands;
      return improve_half(*start, task, max_gap, own, made, part);
    };
    // What counts is the model alone, as for triangles.
    std::optional<TriangleBvh> bvh;
    const MeasureQuadGap gap_of = [&](const PolygonMesh& cage, double tolerance) {
      return greatest_gap_of_quads(join_halves(cage, task.frame).mesh,
                                   bvh ? *bvh : bvh.emplace(model), tolerance);
    };
    Result<QuadStage> stage = make_quads_in_budget(
        {triangles, gap_of, all_rings, task.half.mesh, options, improvement, task.diagonal},
        improving.part(limbs_found, 1));
    if (!stage) {
      return stage.error();
    }
    made.report = std::move(stage->report);
    made.gap = stage->gap;
    watch.lap("improve");
    Whole<PolygonMesh> whole = join_halves(stage->made.cage, task.frame);
    made.quads = report_of(whole.mesh);
    std::vector<Index> parts = stage->made.parts; // of both halves
    parts.insert(parts.end(), stage->made.parts.begin(), stage->made.parts.end());
    made.limb_rings = rings_between(whole.mesh, parts);
    validity = validate_cage(whole.mesh, model, {.first_only = true}, checking);
    made.cage = to_triangle_mesh(whole.mesh);
    made.polygons = std::move(whole.mesh);
    made.mirror = std::move(whole.pairing);
  } else {
    Result<Improved> result =
        options.max_gap > 0
            ? improve_half(*start, task, options.max_gap, improvement, made, improving)
            : improve_well_shaped(*start, task.half.mesh, improvement, improving);
    if (!result) {
      return result.error();
    }
    made.report = std::move(result->report);
    watch.lap("improve");
    Whole<TriangleMesh> whole = join_halves(result->cage, task.frame);
    validity = validate_cage(whole.mesh, model, {.first_only = true}, checking);
    made.cage = std::move(whole.mesh);
    made.mirror = std::move(whole.pairing);
  }
  if (!validity) {
    return validity.error();
  }
  if (!validity->valid()) {
    return not_valid(*validity, remedy);
  }
  watch.lap("check");
  return made;
}

} // namespace cagewright
