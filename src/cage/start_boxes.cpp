#include "cage/box_cage.h"
#include "cage/ground.h"
#include "cage/start.h"
#include "envelope/envelope.h"
#include "mesh/shapes.h"
#include "mesh/topology.h"
#include "spatial/bvh.h"
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

/// Of the diagonal: a model this near to its mirror image is enclosed with it by any box.
constexpr double same = 1e-6;

/// The model; of half a ground, and its mirror image, unless they are the same.
TriangleMesh to_enclose(const Ground& ground) {
  TriangleMesh model{{ground.model().positions.begin(), ground.model().positions.end()},
                     {ground.model().triangles.begin(), ground.model().triangles.end()}};
  return !ground.is_half() || ground.frame().plane().high_error < same
             ? model
             : joined(model, mirror_image(ground.model(), ground.frame().plane()));
}

/// The half of a union, if it makes a valid whole.
Result<TriangleMesh> half_of(const TriangleMesh& united, const Ground& ground,
                             const Progress& progress) {
  const Error no_start{ErrorCode::no_valid_cage,
                       "the union of the boxes cut by the mirror plane is no valid cage"};
  std::optional<TriangleMesh> half = cut_half(in_frame(united, ground.frame()));
  if (!half) {
    return no_start;
  }
  const Result<ValidityReport> validity =
      validate_cage(ground.whole(*half), ground.model(), {.first_only = true}, progress);
  if (!validity) {
    return validity.error();
  }
  return validity->valid() ? Result<TriangleMesh>(std::move(*half)) : no_start;
}

/// Boxes of parts that are near each other may touch where the parts do not: handles that go round
/// nothing are filled, on a grid round the boxes. \returns nothing if they cannot be.
std::optional<TriangleMesh> without_handles(const TriangleMesh& united, const Ground& ground,
                                            int known, const Progress& progress) {
  EnvelopeOptions options;
  constexpr int fine = 64; // as boxes are made
  constexpr double strictly = 1e-4;
  options.resolution = fine;
  options.fill = wide_handle;
  options.own_handles = known;
  options.vertices = std::numeric_limits<int>::max();
  options.clearance = strictly;
  options.half = ground.is_half();
  options.diagonal = ground.diagonal();
  const TriangleMesh here = ground.is_half() ? in_frame(united, ground.frame()) : united;
  Result<Envelope> filled = envelope(here, options, progress);
  return filled && filled->genus <= known ? std::optional(std::move(filled->mesh)) : std::nullopt;
}

} // namespace

Result<Start> start_from_boxes(const Ground& ground, const GenerateOptions& options,
                               const StartTry& /*how*/, const Progress& progress) {
  constexpr double united = 0.95; // of the time
  Result<BoxCage> boxes =
      make_box_cage(to_enclose(ground), options, options.clearance, progress.part(0, united));
  if (!boxes) {
    return boxes.error();
  }
  Start start;
  start.method = Method::boxes_improved;
  start.surface = std::move(boxes->cage);
  const std::optional<int> known = known_handles(ground.model());
  std::optional<TriangleMesh> filled;
  if (known && topology(TriangleView(start.surface)).genus.value_or(0) > *known) {
    filled = without_handles(start.surface, ground, *known, progress.part(united, 1));
  }
  if (filled) {
    start.surface = std::move(*filled);
  } else if (ground.is_half()) {
    Result<TriangleMesh> half = half_of(start.surface, ground, progress.part(united, 1));
    if (!half) {
      return half.error();
    }
    start.surface = std::move(*half);
  }
  // Boxes that were joined may come nearer than the clearance. No step of the improvement comes
  // nearer still.
  const double least =
      mesh_distance(TriangleBvh(start.surface), TriangleBvh(ground.enclosed())).distance;
  if (!(least > 0)) {
    return Error{ErrorCode::no_valid_cage, "the union of the boxes touches the model"};
  }
  constexpr double below = 0.99;
  start.clearance = std::min(options.clearance, below * least / ground.diagonal());
  start.boxes = std::move(boxes->made);
  return start;
}

} // namespace cagewright
