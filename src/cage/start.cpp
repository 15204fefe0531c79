#include "cage/start.h"

#include "cage/budget.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cagewright {
namespace {

using MakeStart = Result<Start> (*)(const Ground&, const GenerateOptions&, const StartTry&,
                                    const Progress&);

MakeStart maker_of(Method method) {
  switch (method) {
  case Method::envelope:
    return start_from_envelope;
  case Method::boxes:
  case Method::boxes_improved:
    return start_from_boxes;
  }
  return start_from_envelope;
}

} // namespace

StartTry first_start(const GenerateOptions& options) {
  return {options.method, {options.envelope_resolution, options.closing}, 0};
}

bool is_open(const GenerateOptions& options, const StartTry& how) {
  return how.method == Method::envelope && !options.quads && how.envelope.resolution == 0 &&
         how.envelope.closing == 0 && how.envelope_vertices == 0 && options.max_gap == 0 &&
         vertices_allowed(options) > 0;
}

// If the envelope has more handles than the budget can go round, though it seemed enough for them,
// more of them are filled, and all if need be: a knot has but one, and it takes many vertices to go
// along it. Where a gap is asked for handles are not filled for vertices' sake.
std::vector<StartTry> starts_of_fewer_handles(const GenerateOptions& options) {
  if (options.envelope_resolution != 0 || options.max_gap != 0) {
    return {};
  }
  constexpr int none = 1; // vertices enough to go round none
  std::vector<StartTry> starts(2, first_start(options));
  starts[0].envelope_vertices = std::max(none, vertices_allowed(options) / 2);
  starts[1].envelope_vertices = none;
  return starts;
}

std::vector<StartTry> starts_of_finer_voxels(const GenerateOptions& options, int resolution) {
  struct Finer {
    double times;
    int least; // the gaps between limbs do not grow with the budget
  };
  std::vector<StartTry> starts;
  for (const auto& [times, least] : {Finer{1.75, 0}, Finer{2.3, 96}, Finer{3, 128}}) {
    StartTry& start = starts.emplace_back(first_start(options));
    start.envelope.resolution = std::max(static_cast<int>(std::lround(times * resolution)), least);
    start.envelope.fill = narrow_handle;
  }
  if (options.quads) {
    starts.resize(1); // they take so much longer, and blocks follow gaps by themselves
  }
  return starts;
}

Result<Start> make_start(const Ground& ground, const GenerateOptions& options, const StartTry& how,
                         const Progress& progress) {
  if (how.method == Method::envelope) {
    return maker_of(how.method)(ground, options, how, progress);
  }
  constexpr double usual = 0.7; // of the time: hardly ever do boxes fail
  Result<Start> start = maker_of(how.method)(ground, options, how, progress.part(0, usual));
  if (start || start.error().code != ErrorCode::no_valid_cage) {
    return start;
  }
  const std::string why_not = start.error().message;
  StartTry envelope = how;
  envelope.method = Method::envelope;
  start = start_from_envelope(ground, options, envelope, progress.part(usual, 1));
  if (start) {
    start->why_not_boxes = why_not;
  }
  return start;
}

} // namespace cagewright
