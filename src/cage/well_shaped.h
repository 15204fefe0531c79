/// \file
/// The improvement tried again where it leaves ill shaped faces. Internal to this module.
#pragma once

#include "improve/improve.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

namespace cagewright {

/// As improve(). If a triangle of the cage is a needle then (2 r / R below 0.03), or more than one
/// in twenty is thin (below 0.15), it is tried again with more weight on shape, twice at most; the
/// best shaped cage of those within the budget is kept. A cage that cannot be brought down to the
/// budget stays as it is: that takes long enough once.
///
/// Errors: those of improve().
Result<Improved> improve_well_shaped(TriangleView start, TriangleView model,
                                     const ImproveOptions& options, const Progress& progress = {});

} // namespace cagewright
