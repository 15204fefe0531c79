/// \file
/// Whether a face is concave.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <optional>
#include <span>

namespace cagewright {

/// The first corner at which the face turns the other way than as a whole, seen along its best
/// normal; none for a convex face, and for one without area.
///
/// Cutting a concave quad along the diagonal that does not start there folds it over.
///
/// \param face  three or more indices of positions
/// Cost: O(corners).
std::optional<std::size_t> concave_corner(std::span<const Vec3> positions,
                                          std::span<const Index> face);

} // namespace cagewright
