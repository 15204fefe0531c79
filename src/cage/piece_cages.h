/// \file
/// A cage of several closed surfaces within one budget. Internal to this module.
#pragma once

#include "cage/part_maker.h"
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/symmetry/mirror_pairing.h>

#include <optional>

namespace cagewright {

/// A closed surface for each group of pieces that are apart, all within the budget of the options;
/// groups whose cages meet or lie one within another (by exact predicates) are joined, and a cage
/// is made for them together. So are groups that are no surface, not five times as large as the
/// clearance, or too many for the budget: with the group whose box is nearest.
///
/// \param plane  if there is one the cage is its own mirror image: a group and its image are dealt
///               with as one part, see PartMaker
/// \param maker  makes the cages of the parts: of the same plane
/// \returns judged against the model
/// Errors: those of piece_groups() and `maker`.
/// Cost: each time that groups are joined a cage is made for them, so at most twice as many cages
/// as there are groups, and one for each round for what the largest gives to those that are stuck.
Result<GeneratedCage> make_pieces(TriangleView model, const GenerateOptions& options,
                                  const std::optional<MirrorPlane>& plane, const PartMaker& maker,
                                  const Progress& progress = {});

/// Whether the model has pieces that are apart. Errors: those of voxelize().
Result<bool> has_pieces_apart(TriangleView model, const GenerateOptions& options,
                              const Progress& progress = {});

} // namespace cagewright
