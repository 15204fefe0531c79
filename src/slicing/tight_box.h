/// \file
/// The box of a set of voxels.
#pragma once

#include "obb/oriented_box.h"
#include "voxel/voxel_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// The corners of the voxels that can be corners of their convex hull: of every row of the grid
/// only the ends, and of every layer only the convex outline of these.
///
/// Cost: O(N + R log R) for N voxels in R rows.
std::vector<Vec3> hull_corners(const VoxelGrid& grid, std::span<const std::uint32_t> voxels);

/// How the box of a part is chosen.
enum class BoxFit {
  pca,      ///< the principal axes of the voxel centers, as published
  smallest, ///< the least volume among the parent's axes, the grid's, the principal ones, a search
  aligned,  ///< the same, but away from the parent's and the grid's axes only for much less volume
};

/// A box that contains all corners of the voxels, with `padding` beyond them on every side; axes
/// sorted longest first.
///
/// The principal axes of blocky or L-shaped parts tilt by 20 to 45 degrees, and a child's box can
/// come out larger than its parent's: hence BoxFit::smallest, for boxes to be kept. A box that is
/// to be cut on should rather stay in its parent's frame: cuts across a box that is tilted for a
/// small gain in volume run slantwise through limbs and trunk: hence BoxFit::aligned.
OrientedBox tight_box(const VoxelGrid& grid, std::span<const std::uint32_t> voxels, BoxFit fit,
                      const Mat3& parent_axes, double padding);

} // namespace cagewright
