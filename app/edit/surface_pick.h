/// \file
/// What of the model lies under the cursor.
#pragma once

#include "app/edit/orbit_camera.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <optional>
#include <span>

namespace cagewright::app {

/// A point on a triangle.
struct SurfacePoint {
  Index triangle = 0;
  Vec3 shares = Vec3::Zero(); ///< barycentric: of its corners
  double distance = 0;        ///< along the line of sight
};

/// The first triangle along a line of sight, seen from either side, of a mesh that has just moved:
/// all triangles are looked at, on all cores. Cost: O(T), some 10 ms for a million.
std::optional<SurfacePoint> first_surface_point(TriangleView mesh, const Ray& sight);

} // namespace cagewright::app
