/// \file
/// Distances along a surface.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <vector>

namespace cagewright {

/// Between every two of V vertices, in the units of the surface.
class SurfaceDistances {
public:
  /// By fast marching: the front is unfolded over each triangle as circles about the point that it
  /// seems to come from, so that edges along the way do not matter. Errors are about one part in a
  /// hundred.
  ///
  /// Kimmel and Sethian, "Computing geodesic paths on manifolds", 1998; the point that the front
  /// seems to come from: Novotni and Klein, "Computing geodesic distances on triangular meshes",
  /// 2002.
  ///
  /// \param surface  connected, manifold; the distance to what is not connected is infinite
  /// Cost: O(V^2 log V), parallel; V^2 numbers.
  explicit SurfaceDistances(TriangleView surface, const Progress& progress = {});

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] double operator()(Index a, Index b) const { return table_[a * count_ + b]; }

private:
  std::size_t count_ = 0;
  std::vector<double> table_;
};

} // namespace cagewright
