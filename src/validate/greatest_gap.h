/// \file
/// How far a surface goes from another at most: proved, not sampled.
#pragma once

#include "spatial/bvh.h"
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

/// The greatest of the distances from every point of a surface to the nearest point of another: the
/// directed Hausdorff distance. It lies between the bounds.
struct GreatestGap {
  double lower = 0;          ///< attained at `place`
  double upper = 0;          ///< no point of the surface is farther
  Vec3 place = Vec3::Zero(); ///< a point of the surface
};

/// Bounds the distance from the points of a surface to a model, by cutting triangles into four
/// until it is known well enough: the distance to a given triangle of the model is convex, so that
/// over a triangle it is greatest at a corner; and the distance to the model changes no faster than
/// the point moves.
///
/// \param surface    F triangles; the unit is that of the coordinates
/// \param model      not empty
/// \param tolerance  upper - lower at most, > 0
/// Cost: about 100 nearest points for each triangle; parallel, the same on any number of threads.
GreatestGap greatest_gap(TriangleView surface, const TriangleBvh& model, double tolerance);

} // namespace cagewright
