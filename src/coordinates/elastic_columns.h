/// \file
/// The columns of Somigliana coordinates, and how a cage moves them. Internal to this module.
#pragma once

#include "coordinates/surface.h"
#include <cagewright/coordinates/columns.h>
#include <cagewright/coordinates/somigliana.h>

#include <memory>
#include <span>

namespace cagewright {

/// For each vertex, and then for each middle of a quad, nine columns, Phi row by row; for each
/// triangle three, k; then the three coordinates of the point from the center of the cage, and 1.
std::shared_ptr<const ColumnRule> elastic_columns(std::span<const Vec3> cage_at_rest,
                                                  const Surface& surface,
                                                  const SomiglianaOptions& options);

} // namespace cagewright
