// The whole pipeline on one page: what is asked for is checked; a cage of the user's own is moved
// (own_cage.h); a cage of boxes is their union; any other is one closed surface (surface.h), or one
// for each group of pieces that are apart (piece_cages.h), by halves where the model is its own
// mirror image. Each surface goes from a start (start.h) on its ground (ground.h) through triangles
// (triangle_stage.h) or quads (quad_stage.h) to the exact check. All that is done on the canonical
// model (canonical_model.h), and checked on the model itself.
#include <cagewright/cage/generate.h>

#include "cage/asked_model.h"
#include "cage/box_cage.h"
#include "cage/budget.h"
#include "cage/canonical_model.h"
#include "cage/mirroring.h"
#include "cage/own_cage.h"
#include "cage/paired_surface.h"
#include "cage/part_maker.h"
#include "cage/piece_cages.h"
#include "cage/stage_time.h"
#include "cage/surface.h"
#include "cage/triangle_stage.h"
#include "cage/unit_frame.h"
#include "mesh/topology.h"
#include "quads/quads.h"
#include <cagewright/cage/option_table.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

Status check(TriangleView model, const GenerateOptions& options) {
  if (const Status in_range = check_ranges(options); !in_range) {
    return in_range;
  }
  if (options.method == Method::boxes && options.start == nullptr) {
    return success();
  }
  if (options.start == nullptr && vertices_allowed(options) == 0 && options.max_gap == 0) {
    return Error{ErrorCode::invalid_option,
                 "the cage needs a limit: give a number of vertices or faces, or a greatest gap"};
  }
  if (!options.density.empty() && options.density.size() != model.positions.size()) {
    return Error{ErrorCode::invalid_option, "there must be one density for each model vertex"};
  }
  return options.max_gap == 0 || options.start != nullptr
             ? success()
             : can_keep_gap(options.max_gap, options.clearance);
}

Result<GeneratedCage> union_of_boxes(TriangleView model, const GenerateOptions& options,
                                     const Progress& progress) {
  Result<BoxCage> made = make_box_cage(model, options, 0, progress);
  if (!made) {
    return made.error();
  }
  GeneratedCage result;
  result.method = Method::boxes;
  result.faces = std::move(made->faces);
  result.triangles = std::move(made->cage);
  result.start_vertices = result.triangles.positions.size();
  result.pieces = static_cast<int>(topology(TriangleView(result.triangles)).components);
  result.bridges = made->made->boxes.bridges;
  result.box_tree = std::move(made->made);
  result.times = std::move(made->times);
  if (options.quads) {
    result.quads = report_of(result.faces);
  }
  return result;
}

/// A closed surface for each group of pieces that are apart, mirrored if they can be.
Result<GeneratedCage> surfaces_apart(TriangleView model, const GenerateOptions& options,
                                     const Mirroring& mirroring, const Progress& progress) {
  constexpr double usual = 0.9; // of the time: hardly ever are mirrored pieces not to be had
  std::string why_not = mirroring.why_not;
  if (mirroring.plane) {
    const PartMaker maker(model, options, mirroring.plane);
    Result<GeneratedCage> mirrored =
        make_pieces(model, options, mirroring.plane, maker,
                    progress.part(0, mirroring.is_insisted_on ? 1 : usual));
    if (mirrored || mirroring.is_insisted_on || mirrored.error().code == ErrorCode::cancelled) {
      return mirrored;
    }
    why_not = mirrored.error().message;
  }
  const PartMaker maker(model, options, std::nullopt);
  Result<GeneratedCage> made = make_pieces(model, options, std::nullopt, maker,
                                           progress.part(mirroring.plane ? usual : 0, 1));
  if (made && !why_not.empty()) {
    add(*made, {Reason::not_mirrored, why_not, mirroring.is_insisted_on, {}});
  }
  return made;
}

/// Paired left to right where that can be; otherwise a cage that is not, and why.
Result<GeneratedCage> paired_or_plain(TriangleView model, const GenerateOptions& options,
                                      bool are_apart, const Progress& progress) {
  constexpr double usual = 0.9; // of the time
  Mirroring plain{std::nullopt, false, "cages of separate pieces cannot be paired; one cage can"};
  if (!are_apart) {
    Result<GeneratedCage> paired = paired_surface(model, options, progress.part(0, usual));
    if (paired || paired.error().code != ErrorCode::no_valid_cage) {
      return paired;
    }
    plain.why_not = paired.error().message;
  }
  const Progress rest = progress.part(usual, 1);
  return are_apart ? surfaces_apart(model, options, plain, rest)
                   : make_surface(model, options, plain, rest);
}

/// One closed surface or several, improved.
/// \param origin  of the user's coordinates
Result<GeneratedCage> surfaces(TriangleView model, const GenerateOptions& options,
                               const Vec3& origin, const Progress& progress) {
  constexpr double counted = 0.02; // of the time
  constexpr double plane_found = 0.07;
  bool are_apart = false;
  if (options.pieces == Pieces::apart) {
    const Result<bool> apart = has_pieces_apart(model, options, progress.part(0, counted));
    if (!apart) {
      return apart.error();
    }
    are_apart = *apart;
  }
  std::vector<StageTime> times;
  Stopwatch watch(times);
  const Mirroring mirroring =
      choose_mirroring(model, options, origin, progress.part(counted, plane_found));
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  if (options.symmetry != Symmetry::off) {
    watch.lap("symmetry");
  }
  const Progress making = progress.part(plane_found, 1);
  Result<GeneratedCage> made = mirroring.by_topology
                                   ? paired_or_plain(model, options, are_apart, making)
                               : are_apart ? surfaces_apart(model, options, mirroring, making)
                                           : make_surface(model, options, mirroring, making);
  if (made) {
    made->times.insert(made->times.begin(), times.begin(), times.end());
    for (Remark& remark : made->remarks) {
      const bool was_asked = options.symmetry == Symmetry::topology;
      remark.is_shortfall |= was_asked && remark.reason == Reason::not_mirrored;
    }
  }
  return made;
}

/// Whether the cage can be made of the canonical model. A gap as narrow as the clearance allows
/// leaves no room for rounding; and boxes are told in the model's own coordinates.
bool has_room_for(double grid, const GenerateOptions& options) {
  return options.method == Method::envelope &&
         (options.max_gap == 0 || can_keep_gap(options.max_gap - grid, options.clearance + grid));
}

/// The same cage wherever the model is and in whatever unit and order: that of the canonical model,
/// which is judged against the model itself.
Result<GeneratedCage> improved_cage(TriangleView model, const GenerateOptions& options,
                                    const Progress& progress) {
  const Result<UnitFrame> frame = unit_frame(model);
  if (!frame) {
    return frame.error();
  }
  const double grid = canonical_grid(options.clearance);
  if (!has_room_for(grid, options)) {
    return surfaces(model, options, Vec3::Zero(), progress);
  }
  constexpr double usual = 0.98; // of the time
  const CanonicalModel canonical = canonical_model(model, *frame, grid, progress);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  GenerateOptions own = options;
  own.clearance += grid;
  own.max_gap -= options.max_gap > 0 ? grid : 0;
  std::vector<LimbJoint> joints(options.joints.begin(), options.joints.end());
  for (LimbJoint& joint : joints) {
    joint.position = frame->to_unit(joint.position);
  }
  own.joints = joints;
  std::vector<double> density;
  if (!options.density.empty()) {
    for (const Index v : canonical.vertices) {
      density.push_back(options.density[v]);
    }
    own.density = density;
  }
  Result<GeneratedCage> made =
      surfaces(canonical.mesh, own, frame->to_unit(Vec3::Zero()), progress.part(0, usual));
  if (!made) {
    return made;
  }
  bring_back(*made, model, *frame);
  made->clearance = std::min(options.clearance, made->clearance);
  if (made->gap) {
    *made->gap += grid;
  }
  const Progress checking = progress.part(usual, 1);
  const Result<ValidityReport> validity = validate_cage(
      made->faces, model, {.allow_pieces = made->pieces > 1, .first_only = true}, checking);
  if (!validity) {
    return validity.error();
  }
  return validity->valid() ? std::move(made) : surfaces(model, options, Vec3::Zero(), checking);
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

std::string coordinates(const Vec3& p) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.6g, %.6g, %.6g", p.x(), p.y(), p.z());
  return text.data();
}

Remark with_place(Remark remark) {
  if (remark.place) {
    remark.message += " (at " + coordinates(*remark.place) + ")";
  }
  return remark;
}

/// The places are known last, in the model's own coordinates.
void finish_remarks(GeneratedCage& cage, const Specks& specks) {
  // Eyes and buttons are small and apart, too; what makes the box longer is hardly ever meant.
  constexpr double notably = 1.1;
  if (specks.enlargement >= notably) {
    add(cage, remark_of(specks, false));
  }
  if (cage.joined > 0) {
    add(cage, {Reason::pieces_joined,
               "pieces share a surface where their own would meet, lie one within another, or be "
               "too small for the budget",
               false,
               {}});
  }
  for (Remark& remark : cage.remarks) {
    remark = with_place(std::move(remark));
  }
  std::stable_partition(cage.remarks.begin(), cage.remarks.end(),
                        [](const Remark& remark) { return remark.is_shortfall; });
}

/// A cage for what is asked for of the model.
Result<GeneratedCage> generate_for_asked(TriangleView model, const GenerateOptions& options,
                                         const Progress& progress) {
  const Result<AskedModel> asked =
      asked_model(PolygonMesh(TriangleMesh{{model.positions.begin(), model.positions.end()},
                                           {model.triangles.begin(), model.triangles.end()}}),
                  options, progress.quiet());
  if (!asked) {
    return asked.error();
  }
  Result<GeneratedCage> made =
      generate(to_triangle_mesh(asked->mesh), asked->options(options), progress);
  if (made) {
    append_remarks(*made, asked->remarks);
  }
  return made;
}

} // namespace

void append_remarks(GeneratedCage& cage, std::span<const Remark> remarks) {
  for (const Remark& remark : remarks) {
    cage.remarks.push_back(with_place(remark));
  }
}

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
  case Reason::start_changed:
    return "start_changed";
  case Reason::specks_enclosed:
    return "specks_enclosed";
  case Reason::specks_ignored:
    return "specks_ignored";
  case Reason::openings_closed:
    return "openings_closed";
  }
  return "unknown"; // no default above: the compiler points here when a reason is added
}

bool GeneratedCage::is_as_asked() const {
  return std::none_of(remarks.begin(), remarks.end(),
                      [](const Remark& remark) { return remark.is_shortfall; });
}

const Remark* GeneratedCage::find(Reason reason) const {
  const auto at = std::find_if(remarks.begin(), remarks.end(),
                               [&](const Remark& remark) { return remark.reason == reason; });
  return at == remarks.end() ? nullptr : &*at;
}

Result<GeneratedCage> generate(TriangleView model, const GenerateOptions& options,
                               const Progress& progress) {
  if (const Status good = check(model, options); !good) {
    return good.error();
  }
  if (is_model_changed(options)) {
    return generate_for_asked(model, options, progress);
  }
  // What is unfit for voxels is refused below, by who can say more of it.
  const Result<Specks> specks = find_specks(model, progress.quiet());
  if (!specks && specks.error().code == ErrorCode::cancelled) {
    return specks.error();
  }
  // Of the time; the figures come after. Boxes are made soon.
  const double made_by = options.start == nullptr && options.method == Method::boxes ? 0.9 : 0.97;
  const Progress making = progress.part(0, made_by);
  Result<GeneratedCage> made = options.start != nullptr ? own_cage(model, options, making)
                               : options.method == Method::boxes
                                   ? union_of_boxes(model, options, making)
                                   : improved_cage(model, options, making);
  if (!made) {
    return made;
  }
  if (made->box_tree) {
    made->boxes = boxes_of(*made->box_tree);
  }
  finish_remarks(*made, specks ? *specks : Specks());
  made->figures = measure_cage(made->faces, model, {}, progress.part(made_by, 1));
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(1, "done");
  return made;
}

} // namespace cagewright
