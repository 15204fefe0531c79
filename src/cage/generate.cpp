#include <cagewright/cage/generate.h>

#include "cage/box_cage.h"
#include "cage/budget_cage.h"
#include <cagewright/cage/option_table.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <utility>

namespace cagewright {
namespace {

constexpr double made_by = 0.97; // of the time; the figures come after

BoxCageOptions box_options(const GenerateOptions& options) {
  BoxCageOptions boxes;
  boxes.boxes = decompose_options(options);
  boxes.registration = options.registration;
  boxes.quads = options.quads;
  return boxes;
}

std::vector<CageBox> boxes_of(const BoxesMade& made) {
  std::vector<CageBox> boxes;
  for (const int leaf : made.leaves) {
    const OrientedBox box =
        made.boxes.to_model(made.boxes.tree.nodes[static_cast<std::size_t>(leaf)].box);
    boxes.push_back({box.center, box.axes, box.half});
  }
  return boxes;
}

void keep_boxes(GeneratedCage& result, BoxesMade made) {
  result.boxes = boxes_of(made);
  result.box_tree = std::make_shared<const BoxesMade>(std::move(made));
}

Result<GeneratedCage> union_of_boxes(TriangleView model, const GenerateOptions& options,
                                     const Progress& progress) {
  Result<BoxCage> made = make_box_cage(model, box_options(options), progress);
  if (!made) {
    return made.error();
  }
  GeneratedCage result;
  result.method = Method::boxes;
  result.faces = std::move(made->faces);
  result.triangles = std::move(made->cage);
  result.start_vertices = result.triangles.positions.size();
  result.bridges = made->boxes.bridges;
  result.times = std::move(made->times);
  if (options.quads) {
    result.quads = report_of(result.faces);
  }
  keep_boxes(result, std::move(*made));
  return result;
}

std::vector<Remark> remarks_of(const BudgetCage& made, const GenerateOptions& options) {
  std::vector<Remark> remarks;
  if (!made.report.reached) {
    const bool is_gap = options.max_gap > 0 && !(made.gap && *made.gap <= options.max_gap);
    remarks.push_back(
        {is_gap ? Reason::gap_not_kept : Reason::budget_not_reached, made.report.why_not, true});
  }
  if (made.clearance < made.clearance_asked) {
    remarks.push_back({Reason::clearance_not_kept,
                       "the boxes came nearer to the model than the clearance asked for", true});
  }
  if (!made.why_not_boxes.empty()) {
    remarks.push_back({Reason::boxes_not_possible, made.why_not_boxes, true});
  }
  if (!made.mirror && !made.why_not_mirrored.empty()) {
    remarks.push_back(
        {Reason::not_mirrored, made.why_not_mirrored, options.symmetry != Symmetry::automatic});
  }
  if (made.joined > 0) {
    remarks.push_back({Reason::pieces_joined,
                       "pieces share a surface where their own would meet, lie one within another, "
                       "or be too small for the budget",
                       false});
  }
  std::stable_partition(remarks.begin(), remarks.end(),
                        [](const Remark& remark) { return remark.is_shortfall; });
  return remarks;
}

Result<GeneratedCage> improved_cage(TriangleView model, const GenerateOptions& options,
                                    const Progress& progress) {
  BudgetCageOptions budget;
  budget.start = options.method == Method::envelope ? CageStart::envelope : CageStart::obb;
  budget.improve.vertices = vertex_limit(options);
  budget.improve.faces = options.faces;
  budget.improve.clearance = options.clearance;
  budget.improve.rounds = options.rounds;
  budget.improve.density = options.density;
  budget.max_gap = options.max_gap;
  budget.resolution = options.envelope_resolution;
  budget.closing = options.closing;
  budget.boxes = box_options(options);
  budget.symmetry = options.symmetry;
  budget.quads = options.quads;
  Result<BudgetCage> made = make_budget_cage(model, budget, progress);
  if (!made) {
    return made.error();
  }
  GeneratedCage result;
  result.method = made->boxes ? Method::boxes_improved : Method::envelope;
  result.remarks = remarks_of(*made, options);
  result.faces = made->polygons ? std::move(*made->polygons) : PolygonMesh(made->cage);
  result.triangles = std::move(made->cage);
  result.start_vertices = made->start_vertices;
  result.resolution = made->resolution;
  result.genus = made->genus;
  result.bridges = made->bridges;
  result.pieces = made->pieces;
  result.joined = made->joined;
  result.objective = made->report.objective;
  result.clearance = made->clearance;
  result.gap = made->gap;
  result.quads = made->quads;
  result.limb_rings = std::move(made->limb_rings);
  result.mirror = std::move(made->mirror);
  result.times = std::move(made->times);
  if (made->boxes) {
    keep_boxes(result, std::move(*made->boxes));
  }
  return result;
}

} // namespace

std::string_view name_of(Reason reason) {
  switch (reason) {
  case Reason::budget_not_reached:
    return "budget_not_reached";
  case Reason::gap_not_kept:
    return "gap_not_kept";
  case Reason::clearance_not_kept:
    return "clearance_not_kept";
  case Reason::boxes_not_possible:
    return "boxes_not_possible";
  case Reason::not_mirrored:
    return "not_mirrored";
  case Reason::pieces_joined:
    return "pieces_joined";
  }
  return "unknown"; // no default above: the compiler points here when a reason is added
}

bool GeneratedCage::is_as_asked() const {
  return std::ranges::none_of(remarks, &Remark::is_shortfall);
}

Result<GeneratedCage> generate(TriangleView model, const GenerateOptions& options,
                               const Progress& progress) {
  if (const Status in_range = check_ranges(options); !in_range) {
    return in_range.error();
  }
  const bool has_limit = vertex_limit(options) > 0 || options.faces > 0 || options.max_gap > 0;
  if (options.method != Method::boxes && !has_limit) {
    return Error{ErrorCode::invalid_option,
                 "the cage needs a limit: give a number of vertices or faces, or a greatest gap"};
  }
  const Progress making = progress.part(0, made_by);
  Result<GeneratedCage> made = options.method == Method::boxes
                                   ? union_of_boxes(model, options, making)
                                   : improved_cage(model, options, making);
  if (made) {
    made->figures = measure_cage(made->faces, model);
    progress(1, "done");
  }
  return made;
}

} // namespace cagewright
