/// \file
/// A grid of cubes at any angle, each outside, inside or on a surface.
#pragma once

#include <cagewright/core/geometry.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cagewright {

enum class VoxelKind : std::uint8_t {
  outer,  ///< wholly outside
  inner,  ///< wholly inside
  feature ///< touches the surface
};

/// dims[0] x dims[1] x dims[2] voxels of edge `size` along orthonormal axes. Grid coordinates are
/// continuous and count voxels: voxel (i, j, k) is the cube from (i, j, k) to (i+1, j+1, k+1).
struct VoxelGrid {
  Mat3 axes = Mat3::Identity();
  Vec3 origin = Vec3::Zero(); ///< where the corner (0, 0, 0) of voxel (0, 0, 0) is in the world
  double size = 1;            ///< a voxel's edge, in the world's unit
  std::array<int, 3> dims = {0, 0, 0};
  std::vector<VoxelKind> kinds; ///< of voxel (i, j, k) at i + dims[0] * (j + dims[1] * k)

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(dims[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] std::size_t index(const std::array<int, 3>& c) const {
    return index(c[0], c[1], c[2]);
  }
  [[nodiscard]] std::array<int, 3> cell(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(dims[0]);
    const auto ny = static_cast<std::size_t>(dims[1]);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / (nx * ny))};
  }

  /// Distance in `kinds` between neighbours along axis 0, 1 or 2.
  [[nodiscard]] std::size_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? index(0, 1, 0) : index(0, 0, 1);
  }

  [[nodiscard]] Vec3 to_world(const Vec3& grid) const { return origin + axes * (size * grid); }
  [[nodiscard]] Vec3 to_grid(const Vec3& p) const { return axes.transpose() * (p - origin) / size; }

  [[nodiscard]] Vec3 center(int i, int j, int k) const {
    return to_world({i + 0.5, j + 0.5, k + 0.5});
  }
  [[nodiscard]] Vec3 center(std::size_t index) const {
    const auto [i, j, k] = cell(index);
    return center(i, j, k);
  }

  /// The corner of least grid coordinates; the seven others are corner(i + 1, j, k), ...
  [[nodiscard]] Vec3 corner(int i, int j, int k) const {
    return to_world({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
  }

  /// Whether the voxel is inside or on the surface.
  [[nodiscard]] bool occupied(std::size_t index) const { return kinds[index] != VoxelKind::outer; }

  [[nodiscard]] std::size_t count(VoxelKind kind) const {
    return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), kind));
  }
};

} // namespace cagewright
