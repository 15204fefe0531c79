/// \file
/// One closed surface round a model or a part of one. Internal to this module.
#pragma once

#include "cage/mirroring.h"
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

namespace cagewright {

/// One closed surface round a model, made from the start that leads to the best one: a start, the
/// ground it lies on, triangles or quads within the budget, and the exact check.
///
/// \returns no figures yet
/// Errors: those of generate().
/// Cost: at most five starts, each on a half and, should that fail, on the whole; what is made of
/// each is told in triangle_stage.h and quad_stage.h.
Result<GeneratedCage> make_surface(TriangleView model, const GenerateOptions& options,
                                   const Mirroring& mirroring, const Progress& progress = {});

} // namespace cagewright
