/// \file
/// Of several envelopes the one that becomes the best cage, as far as can be told in haste.
/// Internal to this module.
#pragma once

#include "cage/ground.h"
#include "cage/start.h"
#include "envelope/envelope.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <optional>

namespace cagewright {

struct PromisingEnvelope {
  Envelope envelope;
  /// How the second best is made, if it promised about as much.
  std::optional<EnvelopeSetting> rival;
};

/// Makes a cage in haste of each of several envelopes: the one `first`, that the rule chooses, and
/// coarser, finer and more closed ones. The one that comes out best by volume, gaps, webbing and
/// handles is taken.
///
/// \param wanted  that `first` was made with
/// Errors: those of improve().
/// Cost: at most six envelopes, and a run of improve() as a draft of each.
Result<PromisingEnvelope> promising_envelope(const Ground& ground, const GenerateOptions& options,
                                             const EnvelopeOptions& wanted, Envelope first,
                                             const Progress& progress = {});

} // namespace cagewright
