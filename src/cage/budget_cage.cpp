#include "cage/budget_cage.h"

#include "cage/budget_pieces.h"
#include "cage/budget_start.h"
#include "cage/canonical_model.h"
#include "cage/improve_to_gap.h"
#include "cage/limb_rings.h"
#include "cage/mirrored_pieces.h"
#include "cage/not_valid.h"
#include "cage/pieces.h"
#include "cage/quad_stage.h"
#include "cage/symmetric_cage.h"
#include "cage/unit_frame.h"
#include "cage/well_shaped.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <string>
#include <utility>

namespace cagewright {
namespace {

// Shares of the whole time, for the progress bar.
constexpr double started = 0.1;
constexpr double improved = 0.95;
constexpr double limbs_found = 0.05; // of the improvement

Result<TriangleMesh> start_from_boxes(TriangleView model, const BudgetCageOptions& options,
                                      BudgetCage& made, const Progress& progress) {
  BoxCageOptions generate = options.boxes;
  generate.boxes.clearance = options.improve.clearance;
  Result<BoxCage> boxes = make_box_cage(model, generate, progress);
  if (!boxes) {
    return boxes.error();
  }
  made.boxes = std::move(*boxes);
  TriangleMesh start = made.boxes->cage;
  // Boxes that were joined may come nearer than the clearance. No step of the improvement comes
  // nearer still.
  const double least = mesh_distance(TriangleBvh(start), TriangleBvh(model)).distance;
  constexpr double below = 0.99;
  made.clearance = std::min(options.improve.clearance, below * least / diagonal(model.positions));
  return start;
}

constexpr const char* remedy = "try another resolution";

Result<Improved> within_gap(TriangleView start, TriangleView model,
                            const ImproveOptions& improvement, double max_gap, BudgetCage& made,
                            const Progress& progress) {
  Result<ImprovedToGap> result = improve_to_gap(start, model, improvement, max_gap, progress);
  if (!result) {
    return result.error();
  }
  made.gap = result->gap;
  return std::move(result->improved);
}

constexpr int voxels_for_pieces = 96; // along the longest edge, to tell which pieces are apart

/// One closed surface for the whole model, from one start.
/// \param plane  to mirror it in, if that is known; else the options say whether to look for one
Result<BudgetCage> make_from_one_start(TriangleView model, const BudgetCageOptions& options,
                                       const std::optional<MirrorPlane>& plane,
                                       const Progress& progress) {
  if (const Result<UnitFrame> frame = unit_frame(model); !frame) {
    return frame.error();
  }
  BudgetCage made;
  made.clearance_asked = options.improve.clearance;
  Stopwatch watch(made.times);
  if (plane || options.symmetry != Symmetry::off) {
    ChosenPlane chosen{plane, ""};
    if (!plane) {
      chosen = choose_mirror_plane(model, options, progress.part(0, started / 2));
      watch.lap("symmetry");
    }
    made.why_not_mirrored = chosen.why_not;
    if (chosen.plane) {
      Result<BudgetCage> symmetric =
          make_symmetric_cage(model, *chosen.plane, options, progress.part(started / 2, 1));
      if (symmetric) {
        symmetric->clearance_asked = made.clearance_asked;
        symmetric->times.insert(symmetric->times.begin(), made.times.begin(), made.times.end());
        return symmetric;
      }
      const bool insist = plane || options.symmetry != Symmetry::automatic;
      if (insist || symmetric.error().code == ErrorCode::cancelled) {
        return symmetric.error();
      }
      made.why_not_mirrored = symmetric.error().message;
    }
  }
  const Progress part = progress.part(0, started);
  const Result<TriangleMesh> start =
      options.start == CageStart::envelope
          ? start_from_envelope(model, options, CageExtent::whole, 0, made, part)
          : start_from_boxes(model, options, made, part);
  if (!start) {
    return start.error();
  }
  made.start_vertices = start->positions.size();
  watch.lap(options.start == CageStart::envelope ? "envelope" : "boxes");

  ImproveOptions improvement = options.improve;
  improvement.clearance = made.clearance;
  const Progress improving = progress.part(started, improved);
  Result<ValidityReport> validity = ValidityReport();
  if (options.quads) {
    const LimbRings all_rings =
        find_limb_rings(*start, model, vertices_of(improvement), improving.part(0, limbs_found));
    watch.lap("limbs");
    const MakeTriangles triangles = [&](int faces, double max_gap, const LimbRings& rings,
                                        const Progress& part_of_it) {
      ImproveOptions own = improvement;
      own.faces = faces;
      own.parts = rings.parts;
      own.bands = rings.bands;
      return max_gap > 0 ? within_gap(*start, model, own, max_gap, made, part_of_it)
                         : improve(*start, model, own, part_of_it);
    };
    std::optional<TriangleBvh> bvh;
    const MeasureQuadGap gap_of = [&](const PolygonMesh& cage, double tolerance) {
      return greatest_gap_of_quads(cage, bvh ? *bvh : bvh.emplace(model), tolerance);
    };
    Result<QuadStage> stage = make_quads_in_budget(
        {triangles, gap_of, all_rings, model, options, improvement, diagonal(model.positions)},
        improving.part(limbs_found, 1));
    if (!stage) {
      return stage.error();
    }
    made.report = std::move(stage->report);
    made.gap = stage->gap;
    made.quads = stage->made.report;
    made.polygons = std::move(stage->made.cage);
    made.limb_rings = rings_between(*made.polygons, stage->made.parts);
    made.cage = to_triangle_mesh(*made.polygons);
    watch.lap("improve");
    validity =
        validate_cage(*made.polygons, model, {.first_only = true}, progress.part(improved, 1));
  } else {
    Result<Improved> result =
        options.max_gap > 0
            ? within_gap(*start, model, improvement, options.max_gap, made, improving)
            : improve_well_shaped(*start, model, improvement, improving);
    if (!result) {
      return result.error();
    }
    made.cage = std::move(result->cage);
    made.report = std::move(result->report);
    watch.lap("improve");
    validity = validate_cage(made.cage, model, {.first_only = true}, progress.part(improved, 1));
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

/// The cage, or that from the envelope which promised about as much, whichever came out better.
Result<BudgetCage> better_of_two(BudgetCage made, TriangleView model,
                                 const BudgetCageOptions& options, const Progress& progress) {
  BudgetCageOptions other = options;
  other.resolution = made.rival->resolution;
  other.closing = made.rival->closing;
  std::optional<MirrorPlane> plane;
  if (made.mirror) {
    plane = made.mirror->plane;
  } else {
    other.symmetry = Symmetry::off;
  }
  Result<BudgetCage> again = make_from_one_start(model, other, plane, progress);
  if (!again) {
    return again.error().code == ErrorCode::cancelled ? std::move(again)
                                                      : Result<BudgetCage>(std::move(made));
  }
  std::vector<StageTime> times = made.times;
  times.insert(times.end(), again->times.begin(), again->times.end());
  const auto cost = [&](const BudgetCage& cage) {
    return std::pair(!cage.report.reached, cost_of(cage, model));
  };
  if (cost(*again) < cost(made)) {
    again->why_not_mirrored = made.why_not_mirrored;
    made = std::move(*again);
  }
  made.times = std::move(times);
  return made;
}

/// One closed surface for the whole model. If the envelope has more handles than the budget can go
/// round, though it seemed enough for them, more of them are filled, and all if need be: a knot has
/// but one, and it takes many vertices to go along it.
Result<BudgetCage> make_one_piece(TriangleView model, const BudgetCageOptions& options,
                                  const std::optional<MirrorPlane>& plane,
                                  const Progress& progress) {
  constexpr double once = 0.5;  // of the time
  constexpr double usual = 0.9; // hardly ever is there a third start
  Result<BudgetCage> made = make_from_one_start(model, options, plane, progress.part(0, once));
  const bool is_chosen = options.resolution == 0 && options.envelope_vertices == 0;
  if (!made || !is_chosen || options.max_gap > 0) {
    return made;
  }
  // A mirrored cage needs vertices on its plane: so few may not do.
  if (!made->report.reached && made->mirror && !plane && options.symmetry == Symmetry::automatic) {
    BudgetCageOptions whole = options;
    whole.symmetry = Symmetry::off;
    Result<BudgetCage> again = make_from_one_start(model, whole, plane, progress.part(once, usual));
    if (!again && again.error().code == ErrorCode::cancelled) {
      return again;
    }
    if (again && again->report.reached) {
      again->why_not_mirrored = "a mirrored cage takes more vertices than asked for";
      return again;
    }
  }
  if (made->rival && !options.quads) {
    made = better_of_two(*std::move(made), model, options, progress.part(once, usual));
    if (!made) {
      return made;
    }
  }
  double done = usual;
  constexpr int none = 1; // vertices enough to go round none
  for (const int vertices : {vertices_of(options.improve) / 2, none}) {
    if (made->report.reached || made->genus == 0) {
      break;
    }
    BudgetCageOptions simpler = options;
    simpler.envelope_vertices = vertices;
    const double then = (done + 1) / 2;
    Result<BudgetCage> again =
        make_from_one_start(model, simpler, plane, progress.part(done, then));
    done = then;
    if (!again && again.error().code == ErrorCode::cancelled) {
      return again;
    }
    if (again && again->report.reached) {
      made = std::move(again);
    }
  }
  return made;
}

/// Why a cage with these options is not its own mirror image, though it should be; else nothing.
std::string why_not_to_mirror(const BudgetCageOptions& options) {
  if (options.symmetry == Symmetry::off) {
    return "";
  }
  // It would count on both sides.
  if (options.symmetry == Symmetry::automatic && !options.improve.density.empty()) {
    return "a density need not be the same on both sides";
  }
  return "";
}

/// Judged against the model, as a cage of several pieces.
Result<BudgetCage> judged_in_pieces(Result<BudgetCage> made, TriangleView model,
                                    const Progress& progress) {
  if (!made) {
    return made;
  }
  const ValidateOptions in_pieces{.allow_pieces = true, .first_only = true};
  const Result<ValidityReport> validity =
      made->polygons ? validate_cage(*made->polygons, model, in_pieces, progress)
                     : validate_cage(made->cage, model, in_pieces, progress);
  if (!validity) {
    return validity.error();
  }
  return validity->valid() ? std::move(made) : not_valid(*validity, remedy);
}

Result<BudgetCage> make_mirrored(TriangleView model, const MirrorPlane& plane,
                                 const BudgetCageOptions& options, const Progress& progress) {
  const MakeMirrored make{
      [&](TriangleView part, const BudgetCageOptions& own, const Progress& share) {
        return make_one_piece(part, own, plane, share);
      },
      [](TriangleView side, const BudgetCageOptions& own, const Progress& share) {
        return make_one_piece(side, own, std::nullopt, share);
      }};
  return judged_in_pieces(make_mirrored_pieces(model, plane, voxels_for_pieces, options, make,
                                               progress.part(0, improved)),
                          model, progress.part(improved, 1));
}

/// A closed surface for each group of pieces that are apart.
Result<BudgetCage> make_all_pieces(TriangleView model, const BudgetCageOptions& options,
                                   const Progress& progress) {
  if (const Result<UnitFrame> frame = unit_frame(model); !frame) {
    return frame.error();
  }
  if (!options.improve.density.empty() &&
      options.improve.density.size() != model.positions.size()) {
    return Error{ErrorCode::invalid_option, "there must be one density for each model vertex"};
  }
  const Result<PieceGroups> groups =
      piece_groups(model, options.improve.clearance, voxels_for_pieces);
  if (!groups) {
    return groups.error();
  }
  BudgetCageOptions plain = options;
  if (groups->count == 1) {
    plain.boxes.boxes.pieces = Pieces::together;
    return make_one_piece(model, plain, std::nullopt, progress);
  }
  ChosenPlane chosen = choose_mirror_plane(model, options, progress.part(0, started / 2));
  if (chosen.plane) {
    Result<BudgetCage> mirrored =
        make_mirrored(model, *chosen.plane, options, progress.part(started / 2, 1));
    if (mirrored || options.symmetry != Symmetry::automatic ||
        mirrored.error().code == ErrorCode::cancelled) {
      return mirrored;
    }
    chosen.why_not = mirrored.error().message;
  }
  plain.symmetry = Symmetry::off;
  const PieceMaker maker{
      [](TriangleView part, const BudgetCageOptions& own, const Progress& share) {
        return make_one_piece(part, own, std::nullopt, share);
      },
      [](TriangleView part) {
        return AlikeSurfaces{{{part.positions.begin(), part.positions.end()},
                              {part.triangles.begin(), part.triangles.end()}}};
      }};
  Result<BudgetCage> made =
      make_pieces(model, *groups, plain, maker, progress.part(started / 2, improved));
  if (made) {
    made->joined = static_cast<int>(groups->count) - made->pieces;
    made->why_not_mirrored = chosen.why_not;
  }
  return judged_in_pieces(std::move(made), model, progress.part(improved, 1));
}

Result<BudgetCage> made_as_it_is(TriangleView model, const BudgetCageOptions& options,
                                 const Progress& progress) {
  return options.boxes.boxes.pieces == Pieces::apart
             ? make_all_pieces(model, options, progress)
             : make_one_piece(model, options, std::nullopt, progress);
}

/// The same cage wherever the model is and in whatever unit and order: that of the canonical model,
/// which is judged against the model itself.
Result<BudgetCage> made_anywhere(TriangleView model, const BudgetCageOptions& options,
                                 const Progress& progress) {
  const Result<UnitFrame> frame = unit_frame(model);
  const std::size_t densities = options.improve.density.size();
  const double grid = canonical_grid(options.improve.clearance);
  // Boxes are told in the model's own coordinates; and a gap as narrow as the clearance allows
  // leaves no room for rounding.
  const bool has_room = options.max_gap == 0 ||
                        can_keep_gap(options.max_gap - grid, options.improve.clearance + grid);
  if (!frame || !has_room || options.start == CageStart::obb ||
      (densities > 0 && densities != model.positions.size())) {
    return made_as_it_is(model, options, progress);
  }
  constexpr double usual = 0.98; // of the time
  const CanonicalModel canonical = canonical_model(model, *frame, grid);
  BudgetCageOptions own = options;
  own.origin = frame->to_unit(Vec3::Zero());
  own.improve.clearance += grid;
  own.max_gap -= options.max_gap > 0 ? grid : 0;
  std::vector<double> density;
  for (const Index v : canonical.vertices) {
    if (densities > 0) {
      density.push_back(options.improve.density[v]);
    }
  }
  own.improve.density = density;
  Result<BudgetCage> made = made_as_it_is(canonical.mesh, own, progress.part(0, usual));
  if (!made) {
    return made;
  }
  bring_back(*made, model, *frame);
  made->clearance = std::min(options.improve.clearance, made->clearance);
  made->clearance_asked = options.improve.clearance;
  if (made->gap) {
    *made->gap += grid;
  }
  const ValidateOptions judging{.allow_pieces = made->pieces > 1, .first_only = true};
  const Progress checking = progress.part(usual, 1);
  const Result<ValidityReport> validity =
      made->polygons ? validate_cage(*made->polygons, model, judging, checking)
                     : validate_cage(made->cage, model, judging, checking);
  if (!validity) {
    return validity.error();
  }
  return validity->valid() ? std::move(made) : made_as_it_is(model, options, checking);
}

} // namespace

Result<BudgetCage> make_budget_cage(TriangleView model, const BudgetCageOptions& asked,
                                    const Progress& progress) {
  if (asked.max_gap != 0) {
    if (const Status can = can_keep_gap(asked.max_gap, asked.improve.clearance); !can) {
      return can.error();
    }
  }
  BudgetCageOptions options = asked;
  const std::string why_not = why_not_to_mirror(asked);
  if (!why_not.empty()) {
    if (asked.symmetry != Symmetry::automatic) {
      return Error{ErrorCode::invalid_option,
                   why_not + "; leave out the symmetry, or the other option"};
    }
    options.symmetry = Symmetry::off;
  }
  Result<BudgetCage> made = made_anywhere(model, options, progress);
  if (made && !why_not.empty()) {
    made->why_not_mirrored = why_not;
  }
  return made;
}

} // namespace cagewright
