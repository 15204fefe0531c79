/// \file
/// Where the limbs of a surface end.
#pragma once

#include "symmetry/surface_distances.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <vector>

namespace cagewright {

/// The vertices farthest out: those whose mean distance along the surface from all others is
/// greater than all round, and stays so until one has gone some way down. Heads, hands, feet,
/// tails; the farthest out first, `most` of them at most.
///
/// The mean distance: Hilaga and others, "Topology matching for fully automatic similarity
/// estimation of 3D shapes", 2001. Cost: O(V^2).
std::vector<Index> limb_tips(TriangleView surface, const SurfaceDistances& distances,
                             std::size_t most);

} // namespace cagewright
