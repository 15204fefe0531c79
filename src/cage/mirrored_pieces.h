/// \file
/// Cages in pieces that are together their own mirror image. Internal to this module.
#pragma once

#include "cage/budget_pieces.h"
#include "symmetry/mirror_plane.h"

namespace cagewright {

/// The two ways to a cage of a part of the model that is its own mirror image.
struct MakeMirrored {
  MakeCage across; ///< one closed surface that the plane cuts
  MakeCage plain;  ///< for either side a surface of its own: one of them, without regard to a plane
};

/// make_pieces() with pieces that are paired about the plane. The groups are those of the model and
/// its mirror image; a group and its image are dealt with as one part. A part that keeps off the
/// plane gets two cages, one the other's mirror image; any other gets one, which the plane cuts.
///
/// The result is not judged against the model.
/// \param resolution  voxels along the longest edge, to tell which pieces are apart
/// Errors: those of piece_groups() and of the makers.
Result<BudgetCage> make_mirrored_pieces(TriangleView model, const MirrorPlane& plane,
                                        int resolution, const BudgetCageOptions& options,
                                        const MakeMirrored& make, const Progress& progress = {});

} // namespace cagewright
