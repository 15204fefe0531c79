#include "cage/budget_cage.h"

#include "cage/symmetric_cage.h"
#include "cage/unit_frame.h"
#include "envelope/envelope.h"
#include "mesh/measures.h"
#include "spatial/bvh.h"
#include "validate/validate_cage.h"

#include <algorithm>
#include <string>
#include <utility>

namespace cagewright {
namespace {

// Shares of the whole time, for the progress bar.
constexpr double started = 0.1;
constexpr double improved = 0.95;

Result<TriangleMesh> start_from_envelope(TriangleView model, const BudgetCageOptions& options,
                                         BudgetCage& made, const Progress& progress) {
  const ImproveOptions& budget = options.improve;
  EnvelopeOptions start;
  start.resolution = options.resolution;
  start.closing = options.closing;
  start.clearance = budget.clearance;
  // A closed surface has half as many vertices as triangles, and two more.
  start.vertices = budget.vertices > 0 ? budget.vertices
                   : budget.faces > 0  ? budget.faces / 2 + 2
                                       : start.vertices;
  Result<Envelope> envelope_made = envelope(model, start, progress);
  if (!envelope_made) {
    return envelope_made.error();
  }
  made.resolution = envelope_made->resolution;
  made.bridges = envelope_made->bridges;
  made.clearance = budget.clearance;
  return std::move(envelope_made->mesh);
}

Result<TriangleMesh> start_from_boxes(TriangleView model, const BudgetCageOptions& options,
                                      BudgetCage& made, const Progress& progress) {
  Result<GeneratedCage> boxes = generate_cage(model, options.boxes, progress);
  if (!boxes) {
    return boxes.error();
  }
  made.boxes = std::move(*boxes);
  TriangleMesh start = made.boxes->cage;
  // Boxes may come nearer than the clearance. No step of the improvement comes nearer still.
  const double least = mesh_distance(TriangleBvh(start), TriangleBvh(model)).distance;
  constexpr double below = 0.99;
  made.clearance = std::min(options.improve.clearance, below * least / diagonal(model.positions));
  return start;
}

} // namespace

Result<BudgetCage> make_budget_cage(TriangleView model, const BudgetCageOptions& options,
                                    const Progress& progress) {
  if (const Result<UnitFrame> frame = unit_frame(model); !frame) {
    return frame.error();
  }
  BudgetCage made;
  Stopwatch watch(made.times);
  if (options.symmetry != Symmetry::off) {
    const ChosenPlane chosen =
        choose_mirror_plane(model, options.symmetry, progress.part(0, started / 2));
    watch.lap("symmetry");
    made.why_not_mirrored = chosen.why_not;
    if (chosen.plane) {
      Result<BudgetCage> symmetric =
          make_symmetric_cage(model, *chosen.plane, options, progress.part(started / 2, 1));
      if (symmetric) {
        symmetric->times.insert(symmetric->times.begin(), made.times.begin(), made.times.end());
        return symmetric;
      }
      const bool insist = options.symmetry != Symmetry::automatic;
      if (insist || symmetric.error().code == ErrorCode::cancelled) {
        return symmetric.error();
      }
      made.why_not_mirrored = symmetric.error().message;
    }
  }
  const Progress part = progress.part(0, started);
  const Result<TriangleMesh> start = options.start == CageStart::envelope
                                         ? start_from_envelope(model, options, made, part)
                                         : start_from_boxes(model, options, made, part);
  if (!start) {
    return start.error();
  }
  made.start_vertices = start->positions.size();
  watch.lap(options.start == CageStart::envelope ? "envelope" : "boxes");

  ImproveOptions improvement = options.improve;
  improvement.clearance = made.clearance;
  Result<Improved> result = improve(*start, model, improvement, progress.part(started, improved));
  if (!result) {
    return result.error();
  }
  made.cage = std::move(result->cage);
  made.report = std::move(result->report);
  watch.lap("improve");

  const Result<ValidityReport> validity =
      validate_cage(made.cage, model, {.first_only = true}, progress.part(improved, 1));
  if (!validity) {
    return validity.error();
  }
  if (!validity->valid()) {
    return Error{ErrorCode::no_valid_cage,
                 "the cage that was made did not pass the check (" +
                     std::string(name_of(validity->violations.front().kind)) +
                     "); try another resolution"};
  }
  watch.lap("check");
  return made;
}

} // namespace cagewright
