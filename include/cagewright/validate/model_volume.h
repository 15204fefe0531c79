/// \file
/// The volume of a model that may be open, inverted or dirty.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <string_view>

namespace cagewright {

enum class VolumeMethod {
  none,    ///< there are no triangles
  exact,   ///< the mesh is closed and oriented once equal positions are merged: its signed volume
  sampled, ///< it is not: the share of sample points that rays find inside
};

/// The method's name as it stands in JSON.
std::string_view name_of(VolumeMethod method);

struct ModelVolume {
  double value = 0; ///< in the cube of the coordinates' unit, not negative
  VolumeMethod method = VolumeMethod::none;
};

/// The volume that a model encloses.
///
/// Sampled means: a point in the middle of each cell of a grid of 96 along the longest side of the
/// bounding box counts as inside when at least four of the six rays from it along the axes cross
/// the surface unequally often from either side. That closes holes, and does not mind a model that
/// is inverted as a whole. The error is below about 1 % for a compact model; flat sheets have none,
/// bent ones what they half surround.
///
/// Cost: O(T) and a million votes.
ModelVolume model_volume(TriangleView model);

} // namespace cagewright
