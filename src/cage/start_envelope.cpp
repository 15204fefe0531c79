#include "cage/budget.h"
#include "cage/ground.h"
#include "cage/promising_envelope.h"
#include "cage/start.h"
#include "envelope/envelope.h"

#include <utility>

namespace cagewright {
Result<Start> start_from_envelope(const Ground& ground, const GenerateOptions& options,
                                  const StartTry& how, const Progress& progress) {
  EnvelopeOptions wanted;
  wanted.resolution = how.envelope.resolution;
  wanted.closing = how.envelope.closing;
  wanted.fill = how.envelope.fill;
  wanted.clearance = options.clearance;
  for (const int vertices : {vertices_allowed(options), how.envelope_vertices}) {
    wanted.vertices = vertices > 0 ? vertices : wanted.vertices;
  }
  wanted.half = ground.is_half();
  wanted.diagonal = ground.diagonal();
  constexpr double first = 0.2; // of the time
  const bool may_choose = is_open(options, how);
  wanted.fill = may_choose ? narrow_handle : wanted.fill;
  Result<Envelope> made =
      envelope(ground.model_here(), wanted, progress.part(0, may_choose ? first : 1));
  if (!made) {
    return made.error();
  }
  Start start;
  if (may_choose) {
    Result<PromisingEnvelope> best =
        promising_envelope(ground, options, wanted, std::move(*made), progress.part(first, 1));
    if (!best) {
      return best.error();
    }
    made = std::move(best->envelope);
    if (best->rival) {
      start.rival = StartTry{Method::envelope, *best->rival, 0};
    }
  }
  start.surface = std::move(made->mesh);
  start.clearance = options.clearance;
  start.resolution = made->resolution;
  start.genus = made->genus;
  start.known = made->known;
  start.bridges = made->bridges;
  return start;
}

} // namespace cagewright
