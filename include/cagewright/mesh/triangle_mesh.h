/// \file
/// What algorithms take: indexed triangles, owned or in someone else's memory.
#pragma once

#include <cagewright/core/geometry.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>; ///< corner indices, counter-clockwise from outside

/// Read-only triangles over positions. Nothing is owned: the arrays outlive the view.
struct TriangleView {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles; ///< every index is < positions.size()
};

/// The same, owned.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;

  operator TriangleView() const { return {positions, triangles}; } // NOLINT: the intended use
};

} // namespace cagewright
