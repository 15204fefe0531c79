/// \file
/// Which way the edges of a quad mesh should run.
#pragma once

#include "quads/quad_cage.h"

#include <span>
#include <vector>

namespace cagewright {

/// Four directions at right angles in the tangent plane of each vertex, along a limb and round it:
/// the principal directions of curvature, smoothed.
class DirectionField {
public:
  /// Curvature is that of the cage's edges, averaged over two rings of neighbours (Cohen-Steiner
  /// and Morvan, "Restricted Delaunay Triangulations and Normal Cycle", 2003). Where the cage is
  /// round the directions follow those of the neighbours.
  explicit DirectionField(TriangleView cage);

  /// 0 for an edge along one of the directions at both of its ends, 1 at 45 degrees to them.
  [[nodiscard]] double misalignment(Index a, Index b, const Vec3& way) const;

  /// One of the four directions at v.
  [[nodiscard]] const Vec3& direction(Index v) const { return directions_[v]; }
  /// How clear they are, 0 to 1.
  [[nodiscard]] double clarity(Index v) const { return clarity_[v]; }

private:
  [[nodiscard]] double misalignment_at(Index v, const Vec3& way) const;

  std::vector<Vec3> normals_;
  std::vector<Vec3> directions_;
  std::vector<double> clarity_;
};

} // namespace cagewright
