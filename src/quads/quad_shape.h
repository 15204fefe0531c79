/// \file
/// What a good quad is.
#pragma once

#include "quads/quad_cage.h"

#include <algorithm>
#include <array>
#include <span>

namespace cagewright {

/// What every quad of a cage keeps.
struct QuadLimits {
  /// Between the normals of the two triangles, for either diagonal.
  double max_bend_degrees = 40;
  /// Of the angles at the corners, seen along the quad's mean normal.
  double min_angle_degrees = 20;
  double max_angle_degrees = 160; ///< below 180: no concave quad
  double min_quality = 0.03;      ///< 2 r / R of each triangle of either cutting
};

using QuadCorners = std::array<Vec3, 4>;

/// The measures of one quad.
struct QuadShape {
  double bend_degrees = 180;      ///< the larger one of the two diagonals
  double min_angle_degrees = 0;   ///< of the corners
  double max_angle_degrees = 360; ///< above 180: concave
  double quality = 0;             ///< 2 r / R, the least of its four triangles

  /// The limits widened so far that this quad is within them.
  [[nodiscard]] QuadLimits widened(QuadLimits limits) const {
    limits.max_bend_degrees = std::max(limits.max_bend_degrees, bend_degrees);
    limits.min_angle_degrees = std::min(limits.min_angle_degrees, min_angle_degrees);
    limits.max_angle_degrees = std::max(limits.max_angle_degrees, max_angle_degrees);
    limits.min_quality = std::min(limits.min_quality, quality);
    return limits;
  }
  [[nodiscard]] bool within(const QuadLimits& limits) const {
    return bend_degrees <= limits.max_bend_degrees &&
           min_angle_degrees >= limits.min_angle_degrees &&
           max_angle_degrees <= limits.max_angle_degrees && quality >= limits.min_quality;
  }
};

/// Angles are measured after the corners are projected along the normal of the quad's vector area.
QuadShape shape_of(const QuadCorners& q);

QuadCorners corners_of(std::span<const Vec3> positions, const CageFace& quad);

/// The same face; a quad begun at a corner of its shorter diagonal, along which it is cut.
CageFace along_shorter_diagonal(std::span<const Vec3> positions, const CageFace& face);

/// Quads beyond the limits, and tentative ones, become two triangles each.
void split_unfit(QuadCage& cage, const QuadLimits& limits);

/// Twice the vector area of a face.
Vec3 area_vector(std::span<const Vec3> positions, const CageFace& face);

/// How far a face is from what an artist would draw, in a number without unit: 0 for a square; for
/// a triangle, `lone` and its own shape. Very large for a quad outside the limits.
struct FaceWishes {
  QuadLimits limits = {};
  double beyond = 0; ///< by so many degrees a tentative quad may be beyond the limits
  double lone = 4;
  double angle = 1;     ///< of the corners, (a - 90)^2 over 45^2, each
  double bend = 1;      ///< b^2 over 20^2
  double stretch = 0.3; ///< the squared logarithm of long over short side
};
double face_defect(std::span<const Vec3> positions, const CageFace& face, const FaceWishes& wishes);

/// What face_defect() gives for a quad that must not be.
inline constexpr double unfit = 1e6;

} // namespace cagewright
