/// \file
/// Columns for the normals of a cage's triangles and of the corners of its quads. Internal to this
/// module.
#pragma once

#include "coordinates/patches.h"
#include <cagewright/coordinates/columns.h>

#include <memory>
#include <span>

namespace cagewright {

/// One column for each vertex of the cage; one for each triangle, as normal_columns() has them; and
/// four for each patch: m_k = N_k / D and m'_k = sigma_k N'_k / D, with N_k the normals at its
/// corners, D the diagonal of the cage at rest, and the stretch
///     sigma_k = (integral of B_k sigma |N|) / (integral of B_k |N'|),
/// sigma that of the tangents. A corner round which the patch has collapsed gives zero.
std::shared_ptr<const ColumnRule> patch_columns(std::span<const Vec3> cage_at_rest,
                                                const PatchedSurface& surface);

} // namespace cagewright
