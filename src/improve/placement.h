/// \file
/// Where to put one vertex of the cage, the rest held still.
#pragma once

#include "improve/objective.h"

#include <optional>

namespace cagewright {

/// A position for patch.vertex that lowers the objective while the patch's new faces stay clear of
/// the model, sought from patch.position. All new faces are round that vertex. None: not found.
///
/// The faces are pushed off the model by half spaces, one for each point of the model found in the
/// way, until nothing is in the way (cutting planes). The result was checked for clearance, but not
/// for crossing the rest of the cage. In a half a vertex of the plane stays in it, and others keep
/// off it.
std::optional<Vec3> place_clear_of_model(const Guard& guard, const Objective& objective,
                                         const CageMesh& cage, Patch patch);

/// About how much the objective can be lowered by moving patch.vertex, which is on the cage or
/// outside it, from patch.position: a tenth of the cost of finding the place. Of the model only
/// what is nearest to a few points of the faces is heeded.
double promised_gain(const Guard& guard, const Objective& objective, const CageMesh& cage,
                     Patch patch);

/// A position for patch.vertex outside the planes of all removed faces, with the least volume
/// (progressive hulls: Sander, Gu, Gortler, Hoppe and Snyder, "Silhouette Clipping", 2000). The
/// model need not be asked: what encloses the old faces encloses it. None: the planes have no point
/// in common.
std::optional<Vec3> place_outside_patch(const CageMesh& cage, const Patch& patch);

} // namespace cagewright
