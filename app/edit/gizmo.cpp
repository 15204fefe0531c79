#include "app/edit/gizmo.h"

#include "app/edit/pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace cagewright::app {
namespace {

// Sizes in pixels.
constexpr double axis_begin = 14;
constexpr double axis_end = 84;
constexpr double tip_length = 16;
constexpr double tip_width = 6;
constexpr double plane_begin = 26;
constexpr double plane_end = 42;
constexpr double center_radius = 10;
constexpr double ring_radius = 78;
constexpr double view_ring_radius = 94;
constexpr double grab_distance = 8;
constexpr int ring_parts = 72;
// Sines of the angles under which handles are too short, or too narrow, to be dragged.
constexpr double least_axis = 0.17;
constexpr double least_plane = 0.2;

constexpr std::array<Handle, 3> axis_handles = {Handle::x, Handle::y, Handle::z};
constexpr std::array<Handle, 3> plane_handles = {Handle::yz, Handle::zx, Handle::xy};

class ShapeMaker {
public:
  ShapeMaker(const OrbitCamera& camera, const GizmoFrame& frame)
      : frame_(frame), pixel_(camera.pixel_size(frame.origin)),
        to_viewer_(camera.to_viewer(frame.origin)), right_(camera.axes().row(0)),
        up_(camera.axes().row(1)) {}

  std::vector<GizmoShape> translate() {
    for (int i = 0; i < 3; ++i) {
      add_plane(i);
    }
    for (int i = 0; i < 3; ++i) {
      if (add_axis(i, axis_end - tip_length)) {
        add_tip(i, 0);
      }
    }
    add_circle(Handle::view, center_radius, true);
    return sorted();
  }

  std::vector<GizmoShape> scale() {
    for (int i = 0; i < 3; ++i) {
      add_plane(i);
    }
    for (int i = 0; i < 3; ++i) {
      if (add_axis(i, axis_end - 6)) {
        add_tip(i, tip_width);
      }
    }
    add_circle(Handle::view, center_radius, true);
    return sorted();
  }

  std::vector<GizmoShape> rotate() {
    add_circle(Handle::trackball, ring_radius - 4, true);
    add_circle(Handle::view, view_ring_radius, false);
    for (int i = 0; i < 3; ++i) {
      add_ring(i);
    }
    return std::move(shapes_);
  }

private:
  [[nodiscard]] Vec3 axis(int i) const { return frame_.axes.col(i); }
  [[nodiscard]] Vec3 at(const Vec3& pixels) const { return frame_.origin + pixel_ * pixels; }

  bool add_axis(int i, double end) {
    const Vec3 a = axis(i);
    if (a.cross(to_viewer_).norm() < least_axis) {
      return false;
    }
    shapes_.push_back({axis_handles[i], {at(axis_begin * a), at(end * a)}, false, true});
    return true;
  }

  /// An arrow's head, or with a `box` width a square, both facing the viewer.
  void add_tip(int i, double box) {
    const Vec3 a = axis(i);
    const Vec3 side = a.cross(to_viewer_).normalized();
    GizmoShape shape{axis_handles[i], {}, true, true};
    if (box > 0) {
      const Vec3 middle = (axis_end - box) * a;
      shape.points = {at(middle - box * right_ - box * up_), at(middle + box * right_ - box * up_),
                      at(middle + box * right_ + box * up_), at(middle - box * right_ + box * up_)};
    } else {
      const Vec3 base = (axis_end - tip_length) * a;
      shape.points = {at(axis_end * a), at(base + tip_width * side), at(base - tip_width * side)};
    }
    shapes_.push_back(std::move(shape));
  }

  void add_plane(int i) {
    if (std::abs(axis(i).dot(to_viewer_)) < least_plane) {
      return;
    }
    const Vec3 u = axis((i + 1) % 3);
    const Vec3 v = axis((i + 2) % 3);
    shapes_.push_back({plane_handles[i],
                       {at(plane_begin * u + plane_begin * v), at(plane_end * u + plane_begin * v),
                        at(plane_end * u + plane_end * v), at(plane_begin * u + plane_end * v)},
                       true,
                       true});
  }

  void add_circle(Handle handle, double radius, bool filled) {
    GizmoShape shape{handle, {}, filled, true};
    for (int k = 0; k <= ring_parts; ++k) {
      const double angle = 2 * std::numbers::pi * k / ring_parts;
      shape.points.push_back(at(radius * (std::cos(angle) * right_ + std::sin(angle) * up_)));
    }
    shapes_.push_back(std::move(shape));
  }

  /// The half of a ring that is before the ball; all of it when it faces the viewer.
  void add_ring(int i) {
    const Vec3 u = axis((i + 1) % 3);
    const Vec3 v = axis((i + 2) % 3);
    const bool faces = std::abs(axis(i).dot(to_viewer_)) > 0.97;
    // Starts where the ring goes behind the ball, so that the visible half is one run.
    const double first = std::atan2(v.dot(to_viewer_), u.dot(to_viewer_)) - std::numbers::pi / 2;
    const double length = faces ? 2 * std::numbers::pi : std::numbers::pi;
    GizmoShape shape{axis_handles[i], {}, false, true};
    for (int k = 0; k <= ring_parts; ++k) {
      const double angle = first + length * k / ring_parts;
      shape.points.push_back(at(ring_radius * (std::cos(angle) * u + std::sin(angle) * v)));
    }
    shapes_.push_back(std::move(shape));
  }

  /// Those farther from the viewer first.
  std::vector<GizmoShape> sorted() {
    const auto nearness = [&](const GizmoShape& shape) {
      Vec3 sum = Vec3::Zero();
      for (const Vec3& p : shape.points) {
        sum += (p - frame_.origin) / static_cast<double>(shape.points.size());
      }
      return sum.dot(to_viewer_);
    };
    std::stable_sort(shapes_.begin(), shapes_.end(), [&](const GizmoShape& a, const GizmoShape& b) {
      return nearness(a) < nearness(b);
    });
    return std::move(shapes_);
  }

  GizmoFrame frame_;
  double pixel_;
  Vec3 to_viewer_, right_, up_;
  std::vector<GizmoShape> shapes_;
};

/// How far the cursor is from a shape, in pixels: 0 within an area.
double distance_to(const OrbitCamera& camera, const GizmoShape& shape, const Pixel& cursor) {
  std::vector<Pixel> line;
  for (const Vec3& p : shape.points) {
    const std::optional<Projected> at = camera.project(p);
    if (!at) {
      return std::numeric_limits<double>::infinity();
    }
    line.push_back(at->pixel);
  }
  if (shape.filled && contains(line, cursor)) {
    return 0;
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double t = nearest_fraction(cursor, line[i], line[i + 1]);
    least = std::min(least, (line[i] + t * (line[i + 1] - line[i]) - cursor).norm());
  }
  return least;
}

} // namespace

std::vector<GizmoShape> gizmo_shapes(const OrbitCamera& camera, TransformKind kind,
                                     const GizmoFrame& frame) {
  if (!camera.project(frame.origin)) {
    return {};
  }
  ShapeMaker maker(camera, frame);
  switch (kind) {
  case TransformKind::translate:
    return maker.translate();
  case TransformKind::rotate:
    return maker.rotate();
  case TransformKind::scale:
    return maker.scale();
  }
  return {};
}

Handle handle_at(const OrbitCamera& camera, TransformKind kind, const GizmoFrame& frame,
                 const Pixel& cursor) {
  Handle best = Handle::none;
  double least = grab_distance;
  bool within_ball = false;
  for (const GizmoShape& shape : gizmo_shapes(camera, kind, frame)) {
    const double distance = distance_to(camera, shape, cursor);
    if (shape.handle == Handle::trackball) {
      within_ball = distance == 0;
    } else if (distance <= least) { // of equals the one drawn last, which is in front
      least = distance;
      best = shape.handle;
    }
  }
  return best == Handle::none && within_ball ? Handle::trackball : best;
}

int axis_of(Handle handle) {
  switch (handle) {
  case Handle::x:
  case Handle::yz:
    return 0;
  case Handle::y:
  case Handle::zx:
    return 1;
  case Handle::z:
  case Handle::xy:
    return 2;
  case Handle::none:
  case Handle::view:
  case Handle::trackball:
    return -1;
  }
  return -1;
}

bool is_plane(Handle handle) {
  return handle == Handle::yz || handle == Handle::zx || handle == Handle::xy;
}

} // namespace cagewright::app
