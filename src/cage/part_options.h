/// \file
/// A part of a model has a diagonal of its own: options and results in terms of it. Internal to
/// this module.
#pragma once

#include "cage/pieces.h"
#include <cagewright/cage/generated_cage.h>

#include <vector>

namespace cagewright {

struct PartOptions {
  GenerateOptions options;
  std::vector<double> density; ///< that the options refer to, if the model has one
};

/// The options for one closed surface round a part of the model: lengths are stated in the part's
/// own diagonals.
///
/// \param whole  diagonal that the lengths of `options` are stated in
PartOptions options_for(const ModelPart& part, double whole, const GenerateOptions& options);

/// States the lengths of a cage round a part in other diagonals.
///
/// \param factor  the diagonal they are stated in over the new one
void restate(GeneratedCage& cage, double factor);

} // namespace cagewright
