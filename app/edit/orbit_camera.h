/// \file
/// The camera of the viewport: it goes round a target, and maps between pixels and space.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/render/camera.h>

#include <optional>

namespace cagewright::app {

/// A place on the screen, in logical pixels from the left and from the top.
using Pixel = Eigen::Vector2d;

struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = -Vec3::UnitZ(); ///< of length 1

  [[nodiscard]] Vec3 at(double distance) const { return origin + distance * direction; }
};

/// Where a point appears.
struct Projected {
  Pixel pixel = Pixel::Zero();
  double depth = 0; ///< distance in front of the eye, along the line of sight
};

enum class StandardView { front, back, right, left, top, bottom };

/// A turntable: the up axis stays upright on the screen, the eye looks at the target.
///
/// In the orthographic projection things have the size that they have at the target's distance in
/// the perspective one, so that switching keeps the target in place and size.
class OrbitCamera {
public:
  void resize(double width, double height); ///< in logical pixels, > 0
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }

  void set_up(UpAxis up) { up_ = up; }
  [[nodiscard]] UpAxis up() const { return up_; }

  /// What is to be seen, for the depth range and for how far one can zoom.
  void set_scene(const Box3& box) { scene_ = box; }

  /// Turns by a drag; across the height of the viewport it is half a turn.
  void orbit(const Pixel& drag);
  /// Shifts so that what lies at the target's depth follows the cursor.
  void pan(const Pixel& drag);
  /// Comes closer by so many clicks of the wheel (away where negative); what lies under the cursor
  /// at the target's depth stays there.
  void zoom(double steps, const Pixel& cursor);
  /// Moves and zooms, without turning, until the box fills the viewport. An empty box: no change.
  void frame(const Box3& box);
  void look(StandardView view);
  /// Looks from the opposite side.
  void look_opposite();

  [[nodiscard]] bool is_perspective() const { return perspective_; }
  void set_perspective(bool perspective) { perspective_ = perspective; }

  [[nodiscard]] const Vec3& target() const { return target_; }
  [[nodiscard]] double distance() const { return distance_; }
  [[nodiscard]] const View& view() const { return view_; }
  /// As a project file stores it. Values that make no sense are corrected.
  void restore(const Vec3& target, double distance, const View& view, bool perspective);

  /// Rows: right, up and backward.
  [[nodiscard]] Mat3 axes() const { return view_axes(view_, up_); }
  [[nodiscard]] Vec3 eye() const;
  /// The unit vector from a point towards the viewer.
  [[nodiscard]] Vec3 to_viewer(const Vec3& p) const;

  /// The line of sight through a pixel. It starts at the eye, or before all of the scene.
  [[nodiscard]] Ray ray(const Pixel& pixel) const;
  /// Nothing for points that are not in front of the eye.
  [[nodiscard]] std::optional<Projected> project(const Vec3& p) const;
  /// The point at a pixel as deep in the picture as p.
  [[nodiscard]] Vec3 at_depth_of(const Vec3& p, const Pixel& pixel) const;
  /// Length of a pixel, across the line of sight, at a point; positive even behind the eye.
  [[nodiscard]] double pixel_size(const Vec3& p) const;

  /// From space, after shifting by -center and scaling, to OpenGL's clip coordinates: for points
  /// q = (p - center) * scale in single precision.
  [[nodiscard]] Eigen::Matrix4d clip_matrix(const Vec3& center, double scale) const;
  /// Half the height of the picture at distance 1, or half its height when orthographic.
  [[nodiscard]] double half_height() const;
  /// Least and greatest depth of what is drawn.
  [[nodiscard]] Eigen::Vector2d depth_range() const;

private:
  double width_ = 640;
  double height_ = 480;
  UpAxis up_ = UpAxis::y;
  View view_ = {};
  Vec3 target_ = Vec3::Zero();
  double distance_ = 4;
  bool perspective_ = true;
  Box3 scene_;
};

} // namespace cagewright::app
