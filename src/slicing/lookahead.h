/// \file
/// How good a cut is, judged by what the next cuts can make of its parts.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/partition.h"
#include "slicing/voxel_owners.h"
#include "voxel/voxel_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// A coarse copy of a part of a grid, on which cuts are tried out.
///
/// The cut that saves most at once is not always the best: a ring must first be cut in two, which
/// saves nothing, before cuts across its halves open the hole. So a cut is judged by the volume
/// that is left after each of its parts has been cut once more.
class Lookahead {
public:
  /// \param voxels  of the part, at least one, in a grid whose outermost layer is empty
  /// \param padding length by which boxes reach beyond their voxels
  Lookahead(const VoxelGrid& grid, std::span<const std::uint32_t> voxels, const OrientedBox& box,
            bool split_parts, double padding);

  /// The share of the volume of the cut's boxes that is left after each has been cut again, in
  /// (0, 1]; 1 when the plane cuts nothing off. Thread-safe.
  ///
  /// Cost: some 1,000 voxels' sweeps, whatever the size of the part.
  [[nodiscard]] double share_left(const CutPlane& plane) const;

  /// Planes at a quarter, at the middle, ... of each axis: among them are the cuts that only a look
  /// ahead can judge.
  [[nodiscard]] std::vector<CutPlane> evenly_spaced_planes(double margin) const;

private:
  const OrientedBox& box_;
  bool split_parts_;
  double padding_;
  VoxelGrid coarse_;
  std::vector<std::uint32_t> voxels_;
  VoxelOwners owners_;
};

} // namespace cagewright
