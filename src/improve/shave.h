/// \file
/// A knob that stands off the model, taken off the cage.
#pragma once

#include "improve/simplify.h"

namespace cagewright {

/// Draws the vertex `tip` and its neighbours together, one after the other, until what is left is
/// at most half as far from the model: for fins and knobs of several vertices, such as a union of
/// boxes leaves, which no single collapse takes away without folding its faces more sharply. While
/// it goes on they may be folded; in the end no two faces are folded more sharply and none is
/// thinner than `limits` allow, and no vertex has more than `most_valence` faces, unless the worst
/// of the cage had before. The cage stays valid throughout, and as it was if that cannot be done.
/// \returns whether it was done
bool shave_tip(WorkingCage& cage, const Guard& guard, const Objective& objective, Index tip,
               std::size_t most_valence, const ShapeLimits& limits = {});

} // namespace cagewright
