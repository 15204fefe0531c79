/// \file
/// The smallest quadratic program: three unknowns under half spaces.
#pragma once

#include "spatial/surface_tree.h"

#include <optional>
#include <span>

namespace cagewright {

/// The point x that minimises 1/2 x.H x + g.x among those in all half spaces; none if they have no
/// point in common. H is symmetric positive definite; the normals have length one.
///
/// Seidel's incremental scheme ("Small-dimensional linear programming and convex hulls made
/// easy", 1991) carried over to a strictly convex objective: linear in the half spaces on average.
std::optional<Vec3> minimize_in_half_spaces(const Mat3& hessian, const Vec3& gradient,
                                            std::span<const HalfSpace> half_spaces);

} // namespace cagewright
