/// \file
/// The cross-section function f(x) of a part of a voxel grid along the axes of its box.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/voxel_owners.h"
#include "voxel/voxel_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

struct CrossSectionOptions {
  /// Connected parts of a slice smaller than this fraction of the slice's occupied area are noise
  /// of the rasterisation, and do not count as the smallest part.
  double min_part = 0.04;
  /// Slices on either side that the median filter looks at; 0 leaves f as it was sampled.
  int median_radius = 1;
};

/// f(x) = the least area among the connected parts of the slice at x (Xian, Lin and Gao, "Automatic
/// cage generation by improved OBBs for mesh deformation", 2012), in units of length squared.
struct CrossSection {
  int axis = 0;               ///< axis of the box that the slices are perpendicular to
  double first = 0;           ///< position of the first slice: local coordinate along the axis
  double step = 0;            ///< distance between slices
  std::vector<double> area;   ///< f as sampled, one value for each slice
  std::vector<double> smooth; ///< f after the median filter: what the slicing rule reads

  /// The local coordinate of the plane half-way between slice k and slice k + 1.
  [[nodiscard]] double between(std::size_t k) const {
    return first + (static_cast<double>(k) + 0.5) * step;
  }
};

/// Samples f along one axis of the box.
///
/// The slices are rasters of the box's own frame, with the grid's voxel size as spacing: looking up
/// every sample in the grid, rather than binning voxels, gives an f that does not depend on how the
/// box lies in the grid. Parts are 8-connected.
///
/// \param box    the box of the part
/// \param part   the label of the voxels that count as occupied
/// Cost: O(volume of the box / voxel volume).
CrossSection cross_section(const VoxelGrid& grid, const VoxelOwners& owners, std::uint32_t part,
                           const OrientedBox& box, int axis,
                           const CrossSectionOptions& options = {});

/// The greatest jump of f between a neighbouring local minimum and local maximum.
struct Jump {
  std::size_t slice = 0; ///< cut between this slice and the next: the steepest step of the jump
  double height = 0;     ///< |f(max) - f(min)| as a fraction of the greatest f; 0 when f is flat
};

/// Looks for the greatest jump whose steepest step leaves at least `margin` slices on either side.
Jump greatest_jump(std::span<const double> f, std::size_t margin);

} // namespace cagewright
