/// \file
/// Columns for the normals of a cage's triangles. Internal to this module.
#pragma once

#include "coordinates/surface.h"
#include <cagewright/coordinates/columns.h>

#include <memory>
#include <span>
#include <vector>

namespace cagewright {

/// One column for each vertex of the cage, then one for each triangle with area of the surface, in
/// order: m = D n and m' = D sigma n', with D the diagonal of the cage at rest (so that all weights
/// are numbers without unit), n the normal and sigma the stretch of the triangle (Lipman, Levin,
/// Cohen-Or 2008). A triangle that has collapsed takes the direction of those round it.
std::shared_ptr<const ColumnRule> normal_columns(std::span<const Vec3> cage_at_rest,
                                                 const Surface& surface);

/// The same for triangles of cage vertices alone.
/// \param unit  D
std::shared_ptr<const ColumnRule> triangle_columns(std::span<const Vec3> cage_at_rest,
                                                   std::vector<Triangle> triangles, double unit);

/// The stretch of a triangle or patch with edge or tangent vectors u, v at rest and u', v' now:
/// sqrt((|u'|^2 |v|^2 - 2 (u'.v') (u.v) + |v'|^2 |u|^2) / 2) / |u x v|.
double stretch(const Vec3& u, const Vec3& v, const Vec3& u_now, const Vec3& v_now);

} // namespace cagewright
