/// \file
/// From a model to a cage that is proved valid: the one door.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

/// Makes a cage round a model: closed, manifold, oriented outward, without degenerate faces or
/// self-intersections, every vertex of the model strictly inside, no face of the model touching it.
/// That is decided by exact predicates on the very coordinates that are returned.
///
/// If not all that is asked for can be had, the nearest valid cage is returned (of a number of
/// vertices the smallest), and its remarks say why: see GeneratedCage::is_as_asked().
///
///     const auto made = cagewright::generate(model, {.vertices = 60, .quads = true});
///
/// \param model  any triangles: open, inverted, self-intersecting, in several pieces
/// Errors: unfit_model (no faces, not finite, all on one line, too far from the origin for its
/// size), invalid_option (out of range, or two that contradict each other), no_valid_cage,
/// too_large, cancelled.
/// Cost: one to four seconds for 100 vertices round a model of 50,000 triangles, on two cores; with
/// quads a few times as much. The same result on any number of threads.
Result<GeneratedCage> generate(TriangleView model, const GenerateOptions& options = {},
                               const Progress& progress = {});

} // namespace cagewright
