/// \file
/// A part of a voxel grid cut by a plane into connected parts.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/voxel_owners.h"
#include "voxel/voxel_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// A plane perpendicular to an axis of a box.
struct CutPlane {
  int axis = 0;      ///< of the box: 0 is its longest
  double offset = 0; ///< local coordinate along the axis, from the box's center
};

/// Cuts a part in two by the centers of its voxels, then each half into its connected parts.
///
/// A crumb (a part no thicker than two voxels along the axis, or a small one whose own box saves
/// nothing) goes back to the part across the plane that it touches most, so that no sliver boxes
/// result.
///
/// \param split_parts  false keeps each half whole, connected or not: strictly two parts
/// \returns the lists of voxels, ascending, ordered by their first voxel; one list when the plane
///          cuts nothing off.
std::vector<std::vector<std::uint32_t>> partition(const VoxelGrid& grid, const VoxelOwners& owners,
                                                  std::uint32_t part,
                                                  std::span<const std::uint32_t> voxels,
                                                  const OrientedBox& box, const CutPlane& plane,
                                                  bool split_parts);

} // namespace cagewright
