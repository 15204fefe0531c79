/// \file
/// A cage whose faces and vertices are paired left to right round a model that is in a pose.
/// Internal to this module.
#pragma once

#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

/// The model is brought into a symmetric pose (symmetry/symmetric_pose.h), by way of a surface of
/// about a thousand vertices round it whose left and right are found (symmetry/posed_reflection.h).
/// A mirrored cage is made there as make_surface() does, taken back into the pose, and made valid
/// and tight by moving its vertices (own_cage.h).
///
/// \returns no figures yet
/// Errors: no_valid_cage, with a sentence that says why: the model's left and right were not found,
/// or no cage came of it; and those of make_surface().
/// Cost: that of find_posed_reflection(), of make_surface() for a half, and of own_cage().
Result<GeneratedCage> paired_surface(TriangleView model, const GenerateOptions& options,
                                     const Progress& progress = {});

} // namespace cagewright
