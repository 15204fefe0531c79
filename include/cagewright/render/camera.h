/// \file
/// Where a picture is taken from.
#pragma once

#include <cagewright/core/geometry.h>

#include <optional>
#include <string_view>
#include <vector>

namespace cagewright {

enum class UpAxis { y, z };

/// A direction of sight. Angle 0, 0 looks at the model's face: from +z where y is up, from -y where
/// z is up.
struct View {
  double yaw_degrees = 35;   ///< round the up axis; at 90 the camera stands on the +x side
  double pitch_degrees = 15; ///< how far the camera is raised; 90 looks straight down
};

/// front, back, left, right, side (as right), top, bottom, three-quarter; nothing for other names.
std::optional<View> view_named(std::string_view name);

/// Rows: right, up and backward (towards the viewer) of a view, in the model's coordinates.
Mat3 view_axes(const View& view, UpAxis up);

/// A pinhole camera.
struct Camera {
  Mat3 axes = Mat3::Identity();  ///< rows: right, up and backward in the model's coordinates
  Vec3 eye = Vec3::Zero();       ///< along these axes
  double tan_half_height = 0.25; ///< of the angle of view
  double nearest = 0.1;          ///< distance of the nearest thing to draw
  double farthest = 10;
};

/// A camera looking along `view` whose picture of the points is as large as its frame of
/// `aspect` (width over height) allows, `margin` (a fraction of the frame) left free on each side.
/// The picture stands in the middle. No points: as for the origin. Cost: nine passes over the
/// points.
Camera fitted_camera(const View& view, UpAxis up, double angle_degrees, double aspect,
                     double margin, const std::vector<Vec3>& points);

} // namespace cagewright
