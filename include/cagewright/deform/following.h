/// \file
/// How well a model follows its cage, in figures.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <span>

namespace cagewright {

/// How much of the weights of points belongs to vertices of the cage that the points do not see:
/// limbs are dragged by what lies across a gap as much as that is.
struct UnseenShare {
  double mean = 0;        ///< of sum over unseen vertices of |w| / sum of |w|, in [0, 1]
  double high = 0;        ///< its 95th percentile
  std::size_t points = 0; ///< that were looked at: those with weights, of some thousands at most
};

/// A point sees a vertex if the open segment between them does not meet the cage, to rounding. Of
/// kinds whose columns are not vertices, weights are those of add_influence().
///
/// \param cage         what the coordinates were prepared of; quads as triangulate() cuts them
/// \param coordinates  of P points
/// Errors: cancelled.
/// Cost: O(C log F) a point, of which at most 4096 are looked at, evenly spread over their order.
/// The same on any number of threads.
Result<UnseenShare> unseen_share(const PolygonMesh& cage, const Coordinates& coordinates,
                                 std::span<const Vec3> points, const Progress& progress = {});

/// What became of a surface. Stretch of a triangle: how many times as long a line on it can have
/// become, or as short; 1 where lengths are kept.
struct DeformedFigures {
  double mean_stretch = 1;    ///< by area at rest
  double high_stretch = 1;    ///< of 95 % of the area none is greater
  double max_stretch = 1;     ///< infinite where a triangle has lost its area
  double volume_change = 0;   ///< new / old - 1; 0 for surfaces without volume
  std::size_t flipped = 0;    ///< triangles that look against those round them, and did not before
  std::size_t in_contact = 0; ///< triangles that cross or touch others, which they did not at rest
};

/// \param rest    T triangles; those without area do not count
/// \param posed   a position for each vertex
/// Cost: O(T log T), and what it takes to compare triangles whose boxes overlap. The same on any
/// number of threads.
DeformedFigures deformed_figures(TriangleView rest, std::span<const Vec3> posed);

} // namespace cagewright
