/// \file
/// The similarity between a model's own coordinates and those all lengths are stated in.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <span>
#include <vector>

namespace cagewright {

/// Maps a model to one whose bounding box has its center at the origin and a diagonal of 1: what
/// follows then works the same on models of any size and place.
struct UnitFrame {
  Vec3 center = Vec3::Zero(); ///< of the model's bounding box
  double diagonal = 1;        ///< of the model's bounding box

  [[nodiscard]] Vec3 to_unit(const Vec3& p) const { return (p - center) / diagonal; }
  [[nodiscard]] Vec3 from_unit(const Vec3& p) const { return p * diagonal + center; }
};

/// The frame of a model that a cage can be built around.
///
/// Errors: unfit_model when there are no faces, when a coordinate is not finite, when all points
/// coincide or lie on one line, or when the model is so small for its distance from the origin that
/// its coordinates have fewer than six digits left.
Result<UnitFrame> unit_frame(TriangleView model);

/// The positions in unit coordinates.
std::vector<Vec3> to_unit(const UnitFrame& frame, std::span<const Vec3> positions);

} // namespace cagewright
