/// \file
/// Where a cut pays: the slicing rule that minimises the volume of the boxes.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/partition.h"
#include "slicing/voxel_owners.h"
#include "voxel/voxel_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

struct VolumeRuleOptions {
  bool split_parts = true; ///< each half falls into its connected parts, each with its own box
  int margin = 3;          ///< slices that stay on either side of a cut, at least
  int per_axis = 2;        ///< candidates offered for each axis
  double padding = 0;      ///< length by which boxes reach beyond their voxels
};

/// The cuts across the axes of the box after which the boxes of the connected parts, aligned with
/// the box, have the least total volume: the best few of each axis, to be judged by their real
/// boxes.
///
/// Cutting where the smallest part's area jumps, as published, finds where a part begins or ends;
/// this finds where a cut pays. Both halves of all cuts along an axis come from two sweeps: voxels
/// are added slice by slice to a union-find whose sets keep their extents, and the sum of the sets'
/// volumes is kept up to date.
///
/// Cost: O(26 N) for N voxels, for each axis and direction.
std::vector<CutPlane> volume_cuts(const VoxelGrid& grid, const VoxelOwners& owners,
                                  std::uint32_t part, std::span<const std::uint32_t> voxels,
                                  const OrientedBox& box, const VolumeRuleOptions& options = {});

/// What the best cut of a part can reach, in boxes aligned with `box`.
struct CutVolumes {
  double uncut = 0; ///< volume of the part's own box
  double cut = 0;   ///< least total volume after one cut; that of the uncut box when none is less
};

/// Cost: as volume_cuts(); runs on one thread.
CutVolumes least_volumes(const VoxelGrid& grid, const VoxelOwners& owners, std::uint32_t part,
                         std::span<const std::uint32_t> voxels, const OrientedBox& box,
                         const VolumeRuleOptions& options = {});

} // namespace cagewright
