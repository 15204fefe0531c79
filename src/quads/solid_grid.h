/// \file
/// What a cage must contain, as the voxels of a fine grid.
#pragma once

#include "voxel/voxel_grid.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstdint>
#include <vector>

namespace cagewright {

struct SolidGridOptions {
  Mat3 axes = Mat3::Identity(); ///< of the grid
  int resolution = 56;          ///< voxels along its longest edge
  double clearance = 0;         ///< voxels as near as this to the model count: a length, > 0
  /// The model is the half at x >= 0 of its own mirror image in x = 0, and so is the grid; its
  /// first axis is then the x axis.
  bool half = false;
};

/// The voxels that come near to the model or lie inside it, and how many of them are in any block.
class SolidGrid {
public:
  explicit SolidGrid(VoxelGrid grid);

  [[nodiscard]] const std::array<int, 3>& dims() const { return grid_.dims; }
  [[nodiscard]] double size() const { return grid_.size; }
  [[nodiscard]] Vec3 corner(int i, int j, int k) const { return grid_.corner(i, j, k); }

  /// Whether the block from corner `low` to corner `high` has one of the voxels.
  [[nodiscard]] bool touches(const std::array<int, 3>& low, const std::array<int, 3>& high) const;

  /// The corners of the block of all of them.
  [[nodiscard]] const std::array<int, 3>& low() const { return low_; }
  [[nodiscard]] const std::array<int, 3>& high() const { return high_; }

private:
  [[nodiscard]] std::size_t sum_at(int i, int j, int k) const;

  VoxelGrid grid_; // only its frame
  std::vector<std::uint32_t> sums_;
  std::array<int, 3> low_{};
  std::array<int, 3> high_{};
};

/// One piece, without cavities. Errors: those of voxelize().
Result<SolidGrid> solid_grid(TriangleView model, const SolidGridOptions& options,
                             const Progress& progress = {});

} // namespace cagewright
