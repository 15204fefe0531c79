/// \file
/// The volume of a model that may be open, inverted or dirty.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <string_view>

namespace cagewright {

enum class VolumeMethod {
  none,     ///< there are no triangles
  exact,    ///< the mesh is closed and oriented once equal positions are merged, and winds round
            ///< what it encloses just once: its signed volume
  sampled,  ///< it is open or inconsistent: the share of sample points that are enclosed
  enclosed, ///< it is closed, but overlaps, is doubled or has hollows: the share of sample points
            ///< that it encloses, each counted once
};

/// The method's name as it stands in JSON.
std::string_view name_of(VolumeMethod method);

struct ModelVolume {
  double value = 0; ///< in the cube of the coordinates' unit, not negative
  VolumeMethod method = VolumeMethod::none;
};

/// The volume that a model encloses: 0 where it encloses none.
///
/// Samples are the middles of the cells of a grid of 96 along the longest side of the bounding box.
/// One is enclosed when no way from cell to cell leads from it to the outside without crossing the
/// surface; or when at least four of the six rays from it along the axes cross the surface
/// unequally often from either side, which closes holes. Neither minds the orientation of the
/// whole. The error is below about 1 % for a compact model; flat sheets have none, bent ones what
/// they half surround.
///
/// None if it is to stop.
/// Cost: O(T) and a million samples.
ModelVolume model_volume(TriangleView model, const Progress& progress = {});

} // namespace cagewright
