/// \file
/// Limbs of a quad cage that end in a face, not in a fan of triangles.
#pragma once

#include "quads/quad_guard.h"

#include <cstddef>

namespace cagewright {

/// Where a limb ends in a vertex with triangles about it, takes the vertex out and closes the ring
/// about it by a quad, a triangle, or two faces, which are moved to where the limb ends: fewer
/// vertices, and far fewer triangles. The cage stays valid. Quads beside such a cap may be beyond
/// the guard's limits by `slack_degrees` of bend, and half as much of their angles.
///
/// \returns how many vertices were taken out
/// Cost: O(faces) for each limb that ends so, and the checks of the faces about it.
std::size_t cap_limbs(QuadCage& cage, const QuadGuard& guard, double slack_degrees);

} // namespace cagewright
