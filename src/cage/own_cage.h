/// \file
/// A cage of the user's own made to fit a model. Internal to this module.
#pragma once

#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

/// The cage options.start with its faces and the order of its vertices, moved: first until the
/// model is inside it (enclose.h), then as near to the model as its faces allow (relax_quads.h).
/// It was made for an earlier state of the model, or by hand, with parts of the model outside.
///
/// Vertices at exactly the same position become one, those that no face uses are left out, and a
/// cage that is turned inside out is turned back: a remark tells. Of the options `clearance` and
/// `density` are heeded.
///
/// \returns no figures yet
/// Errors: invalid_cage (not closed or not manifold; nothing that moving vertices could mend),
/// unfit_model, no_valid_cage, cancelled. Cost: that of enclose(), and six runs of relax_quads() at
/// most.
Result<GeneratedCage> own_cage(TriangleView model, const GenerateOptions& options,
                               const Progress& progress = {});

} // namespace cagewright
