#include "app/edit/transform_drag.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace cagewright::app {
namespace {

// Sine of the angle between an axis and the line of sight below which the mouse moves along the
// axis as if it were that wide: 8 degrees. Exact intersections run away there.
constexpr double least_sine = 0.14;
// Sine of the angle between a plane and the line of sight below which it counts as seen edge-on.
constexpr double least_plane_sine = 0.09;
// A ring flatter than this is turned by dragging along it, not round it.
constexpr double least_ring_facing = 0.25;
// Nothing is dragged farther than this, in distances between the eye and the pivot.
constexpr double farthest = 100;
constexpr double degree = std::numbers::pi / 180;

double snapped(double value, double step) {
  return step > 0 ? std::round(value / step) * step : value;
}

std::string number(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g", value == 0 ? 0.0 : value);
  return text.data();
}

} // namespace

void TransformDrag::begin(TransformKind kind, const DragScene& scene, const Pixel& cursor,
                          Handle handle) {
  *this = TransformDrag();
  state_ = State::active;
  kind_ = kind;
  scene_ = scene;
  handle_ = handle;
  first_ = last_ = cursor_ = cursor;
  axes_ = scene.axes;
  if (const int axis = axis_of(handle); axis >= 0) {
    axis_ = axis;
    freedom_ = is_plane(handle) ? Freedom::plane : Freedom::axis;
  } else if (handle == Handle::trackball) {
    freedom_ = Freedom::trackball;
  }
}

void TransformDrag::move(const Pixel& cursor) {
  if (!is_active()) {
    return;
  }
  const Pixel before = cursor_;
  cursor_ += (precise_ ? 0.1 : 1.0) * (cursor - last_);
  last_ = cursor;
  // Turns are summed up from move to move, so that they may go on past half a circle.
  angle_ += std::remainder(angle_at(cursor_) - angle_at(before), 2 * std::numbers::pi);
}

void TransformDrag::confirm() {
  if (is_active()) {
    state_ = State::confirmed;
  }
}

void TransformDrag::cancel() {
  if (is_active()) {
    state_ = State::cancelled;
  }
}

// ---------------------------------------------------------------- keys

AxesKind TransformDrag::other_axes() const {
  return scene_.axes == AxesKind::local ? AxesKind::world : AxesKind::local;
}

void TransformDrag::confine(int axis, bool plane) {
  const Freedom freedom = plane ? Freedom::plane : Freedom::axis;
  presses_ = freedom_ == freedom && axis_ == axis ? presses_ + 1 : 1;
  axis_ = axis;
  freedom_ = presses_ > 2 ? Freedom::free : freedom;
  axes_ = presses_ == 2 ? other_axes() : scene_.axes;
  if (presses_ > 2) {
    presses_ = 0;
  }
  handle_ = Handle::none;
  component_ = std::min(component_, component_count() - 1);
  // The angle is measured anew, round another axis.
  angle_ = std::remainder(angle_at(cursor_) - angle_at(first_), 2 * std::numbers::pi);
}

void TransformDrag::restart() {
  freedom_ = Freedom::free;
  handle_ = Handle::none;
  presses_ = 0;
  axes_ = scene_.axes;
  text_ = {};
  component_ = 0;
  first_ = cursor_ = last_;
  angle_ = 0;
}

bool TransformDrag::key(char key, bool shift) {
  if (!is_active()) {
    return false;
  }
  switch (key) {
  case enter:
    confirm();
    return true;
  case escape:
    cancel();
    return true;
  case 'x':
  case 'y':
  case 'z':
    confine(key - 'x', shift && kind_ != TransformKind::rotate);
    return true;
  case 'g':
    kind_ = TransformKind::translate;
    restart();
    return true;
  case 's':
    kind_ = TransformKind::scale;
    restart();
    return true;
  case 'r': {
    const bool free = kind_ != TransformKind::rotate || freedom_ == Freedom::trackball;
    kind_ = TransformKind::rotate;
    restart();
    freedom_ = free ? Freedom::free : Freedom::trackball;
    return true;
  }
  case tab:
    component_ = (component_ + 1) % component_count();
    return true;
  case backspace:
    if (!text_[component_].empty()) {
      text_[component_].pop_back();
    } else if (component_ > 0) {
      --component_;
    }
    return true;
  default:
    break;
  }
  std::string& text = text_[component_];
  if (key == '-') {
    text = text.starts_with('-') ? text.substr(1) : "-" + text;
    return true;
  }
  const bool is_point = key == '.' || key == ',';
  if ((key >= '0' && key <= '9') || is_point) {
    if (text.size() < 16 && !(is_point && text.find('.') != std::string::npos)) {
      text += is_point ? '.' : key;
    }
    return true;
  }
  return false;
}

int TransformDrag::component_count() const {
  switch (kind_) {
  case TransformKind::translate:
    return freedom_ == Freedom::axis ? 1 : freedom_ == Freedom::plane ? 2 : 3;
  case TransformKind::rotate:
    return freedom_ == Freedom::trackball ? 2 : 1;
  case TransformKind::scale:
    return freedom_ == Freedom::axis ? 1 : freedom_ == Freedom::plane ? 2 : 3;
  }
  return 1;
}

bool TransformDrag::is_typed() const {
  return std::any_of(text_.begin(), text_.end(), [](const std::string& t) {
    return t.find_first_of("0123456789") != std::string::npos;
  });
}

double TransformDrag::typed(int component) const {
  const std::string& text = text_[component];
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return std::isfinite(value) ? value : 0;
}

// ---------------------------------------------------------------- the mouse

Mat3 TransformDrag::frame() const {
  const bool anywhere = freedom_ == Freedom::free || freedom_ == Freedom::trackball;
  switch (anywhere && axes_ == AxesKind::view ? AxesKind::world : axes_) {
  case AxesKind::world:
    return Mat3::Identity();
  case AxesKind::local:
    return scene_.local;
  case AxesKind::view:
    return scene_.camera.axes().transpose();
  }
  return Mat3::Identity();
}

Pixel TransformDrag::pivot_pixel() const {
  const auto at = scene_.camera.project(scene_.pivot);
  return at ? at->pixel : Pixel(scene_.camera.width() / 2, scene_.camera.height() / 2);
}

/// How far along an axis through the pivot the drag has come.
double TransformDrag::along_axis(const Pixel& cursor, const Vec3& axis) const {
  const OrbitCamera& camera = scene_.camera;
  const Pixel drag = cursor - first_;
  const double pixel = camera.pixel_size(scene_.pivot);
  const Pixel middle = pivot_pixel();
  const double sine = axis.cross(camera.to_viewer(scene_.pivot)).norm();

  // The direction of the axis on the screen; upward for one that points at the viewer.
  Pixel direction(0, -1);
  if (const auto tip = camera.project(scene_.pivot + pixel * axis); tip && sine > 1e-6) {
    const Pixel step = tip->pixel - middle;
    direction = step.norm() > 1e-9 ? Pixel(step.normalized()) : direction;
  }
  const double rough = drag.dot(direction) * pixel / std::max(sine, least_sine);
  if (sine < least_sine || !camera.is_perspective()) {
    return rough;
  }
  // The point of the axis nearest to the line of sight.
  const Ray sight = camera.ray(middle + drag);
  const Vec3 w = scene_.pivot - sight.origin;
  const double b = axis.dot(sight.direction);
  const double denominator = 1 - b * b;
  const double limit = farthest * w.norm();
  if (denominator < 1e-8) {
    return std::copysign(limit, rough);
  }
  const double t = (b * sight.direction.dot(w) - axis.dot(w)) / denominator;
  const double depth = (w + t * axis).dot(sight.direction);
  // Past the point where the axis vanishes the nearest point is behind the eye.
  return depth > 0 ? std::clamp(t, -limit, limit) : std::copysign(limit, rough);
}

Vec3 TransformDrag::in_plane(const Pixel& cursor, const Vec3& normal) const {
  const OrbitCamera& camera = scene_.camera;
  const Pixel at = pivot_pixel() + (cursor - first_);
  const Vec3 free = camera.at_depth_of(scene_.pivot, at) - scene_.pivot;
  const Vec3 along_edge = free - free.dot(normal) * normal;
  const Ray sight = camera.ray(at);
  const double facing = sight.direction.dot(normal);
  if (std::abs(normal.dot(camera.to_viewer(scene_.pivot))) < least_plane_sine ||
      std::abs(facing) < 1e-3) {
    return along_edge;
  }
  const double depth = (scene_.pivot - sight.origin).dot(normal) / facing;
  const double limit = farthest * (scene_.pivot - sight.origin).norm();
  if (!(depth > 0 && depth < limit)) { // beyond the horizon
    return along_edge;
  }
  return sight.at(depth) - scene_.pivot;
}

Vec3 TransformDrag::mouse_shift() const {
  if (freedom_ == Freedom::axis) {
    const Vec3 axis = frame().col(axis_);
    return along_axis(cursor_, axis) * axis;
  }
  if (freedom_ == Freedom::plane) {
    return in_plane(cursor_, frame().col(axis_));
  }
  const Pixel at = pivot_pixel();
  return scene_.camera.at_depth_of(scene_.pivot, at + cursor_ - first_) -
         scene_.camera.at_depth_of(scene_.pivot, at);
}

Vec3 TransformDrag::rotation_axis() const {
  if (freedom_ == Freedom::axis || freedom_ == Freedom::plane) {
    return frame().col(axis_);
  }
  return scene_.camera.to_viewer(scene_.pivot);
}

/// The angle of a place on the screen about the pivot, for what turns about rotation_axis().
double TransformDrag::angle_at(const Pixel& cursor) const {
  const Vec3 axis = rotation_axis();
  const double facing = axis.dot(scene_.camera.to_viewer(scene_.pivot));
  const Pixel arm = cursor - pivot_pixel();
  if (handle_ != Handle::none && std::abs(facing) < 0.999) {
    const Ray sight = scene_.camera.ray(cursor);
    const double slope = sight.direction.dot(axis);
    const double depth = (scene_.pivot - sight.origin).dot(axis) / slope;
    if (std::abs(slope) > 1e-3 && depth > 0) {
      const Vec3 p = sight.at(depth) - scene_.pivot;
      const Vec3 u = axis.unitOrthogonal();
      return std::atan2(p.dot(axis.cross(u)), p.dot(u));
    }
  }
  return (facing < 0 ? -1 : 1) * std::atan2(-arm.y(), arm.x());
}

/// For a ring seen from its edge: by how far the cursor went along it.
double TransformDrag::edge_on_angle() const {
  const OrbitCamera& camera = scene_.camera;
  const Vec3 to_viewer = camera.to_viewer(scene_.pivot);
  const Vec3 tangent = rotation_axis().cross(to_viewer).normalized(); // of the ring's near side
  const double pixel = camera.pixel_size(scene_.pivot);
  const Vec3 drag = camera.at_depth_of(scene_.pivot, pivot_pixel() + cursor_ - first_) -
                    camera.at_depth_of(scene_.pivot, pivot_pixel());
  constexpr double ring_pixels = 78;
  return drag.dot(tangent) / (pixel * ring_pixels);
}

Vec3 TransformDrag::mouse_factors() const {
  const Pixel middle = pivot_pixel();
  double factor = 1;
  if (handle_ != Handle::none && freedom_ == Freedom::axis) {
    const auto tip = scene_.camera.project(scene_.pivot + scene_.camera.pixel_size(scene_.pivot) *
                                                              frame().col(axis_));
    const Pixel direction = tip ? Pixel((tip->pixel - middle).normalized()) : Pixel(1, 0);
    const double before = (first_ - middle).dot(direction);
    factor = std::abs(before) > 4 ? (cursor_ - middle).dot(direction) / before : 1;
  } else if ((first_ - middle).norm() > 16) {
    factor = (cursor_ - middle).norm() / (first_ - middle).norm();
  } else { // too near to the pivot to measure by: away to the right and upward grows
    const Pixel drag = cursor_ - first_;
    factor = std::exp((drag.x() - drag.y()) / 100);
  }
  return Vec3::Constant(factor);
}

// ---------------------------------------------------------------- the result

/// Along the frame's axes: a shift or factors; of rotations the angle, or two of a trackball.
Vec3 TransformDrag::amount() const {
  Vec3 value = Vec3::Zero();
  const Mat3 axes = frame();
  const double fineness = precise_ ? 0.1 : 1.0;
  switch (kind_) {
  case TransformKind::translate: {
    value = is_typed() ? Vec3(Vec3::Zero()) : Vec3(axes.transpose() * mouse_shift());
    if (snapping_ && !is_typed()) {
      for (double& v : value) {
        v = snapped(v, scene_.snap_step * scene_.unit * fineness);
      }
    }
    break;
  }
  case TransformKind::rotate:
    if (freedom_ == Freedom::trackball) {
      const Pixel turn = (cursor_ - first_) / 100;
      value = {turn.x(), turn.y(), 0};
    } else {
      const double facing = rotation_axis().dot(scene_.camera.to_viewer(scene_.pivot));
      const bool edge_on = handle_ != Handle::none && std::abs(facing) < least_ring_facing;
      value.x() = edge_on ? edge_on_angle() : angle_;
    }
    if (snapping_ && !is_typed()) {
      for (double& v : value) {
        v = snapped(v, scene_.snap_angle_degrees * degree * fineness);
      }
    }
    break;
  case TransformKind::scale:
    value = mouse_factors();
    if (snapping_ && !is_typed()) {
      for (double& v : value) {
        v = snapped(v, scene_.snap_scale * fineness);
      }
    }
    break;
  }
  if (!is_typed()) {
    return value;
  }
  // What is typed goes to the components that are free, in order.
  value = kind_ == TransformKind::scale ? Vec3(Vec3::Ones()) : Vec3(Vec3::Zero());
  if (kind_ == TransformKind::rotate) {
    for (int i = 0; i < component_count(); ++i) {
      value[i] = typed(i) * degree;
    }
  } else if (freedom_ == Freedom::axis) {
    value[axis_] = typed(0);
  } else {
    int component = 0;
    for (int i = 0; i < 3; ++i) {
      if (freedom_ == Freedom::plane && i == axis_) {
        continue;
      }
      // A single factor counts for all directions.
      const bool same = kind_ == TransformKind::scale && text_[component].empty();
      value[i] = same ? typed(0) : typed(component);
      ++component;
    }
  }
  return value;
}

Transform TransformDrag::transform() const {
  Transform result;
  result.kind = kind_;
  result.pivot = scene_.pivot;
  if (state_ == State::idle || state_ == State::cancelled) {
    return result;
  }
  Vec3 value = amount();
  switch (kind_) {
  case TransformKind::translate: {
    if (freedom_ == Freedom::axis) { // what rounding adds across the axis
      value = value[axis_] * Vec3::Unit(axis_);
    } else if (freedom_ == Freedom::plane) {
      value[axis_] = 0;
    }
    result.shift = frame() * value;
    break;
  }
  case TransformKind::rotate:
    if (freedom_ == Freedom::trackball) {
      const Mat3 view = scene_.camera.axes();
      const Vec3 turn = value.x() * view.row(1).transpose() + value.y() * view.row(0).transpose();
      result.angle = turn.norm();
      result.axis = result.angle > 0 ? Vec3(turn / result.angle) : Vec3(Vec3::UnitZ());
    } else {
      result.axis = rotation_axis();
      result.angle = value.x();
    }
    break;
  case TransformKind::scale:
    result.axes = frame();
    if (freedom_ == Freedom::axis) {
      result.factors[axis_] = value[axis_];
    } else if (freedom_ == Freedom::plane) {
      result.factors = value;
      result.factors[axis_] = 1;
    } else {
      result.factors = value;
    }
    break;
  }
  return result;
}

std::string TransformDrag::caption() const {
  static constexpr std::array<const char*, 3> names = {"X", "Y", "Z"};
  std::string text = kind_ == TransformKind::translate ? "Move"
                     : kind_ == TransformKind::rotate  ? "Rotate"
                                                       : "Scale";
  const std::string frame_name = axes_ == AxesKind::local  ? "local "
                                 : axes_ == AxesKind::view ? "view "
                                                           : "";
  if (freedom_ == Freedom::trackball) {
    text += " freely";
  } else if (freedom_ == Freedom::axis) {
    text += kind_ == TransformKind::rotate ? " about " : " along ";
    text += frame_name + names[axis_];
  } else if (freedom_ == Freedom::plane) {
    text += " in " + frame_name + names[(axis_ + 1) % 3] + names[(axis_ + 2) % 3];
  }
  text += ":  ";
  const Vec3 value = amount();
  const bool typing = is_typed() || !text_[component_].empty();
  int component = 0;
  for (int i = 0; i < 3; ++i) {
    bool shown = i == 0;
    double v = value[i];
    if (kind_ == TransformKind::rotate) {
      shown = i < component_count();
      v /= degree;
    } else if (freedom_ == Freedom::axis) {
      shown = i == axis_;
    } else if (freedom_ == Freedom::plane) {
      shown = i != axis_;
    } else {
      shown = kind_ == TransformKind::translate || typing || i == 0;
    }
    if (!shown) {
      continue;
    }
    if (component > 0) {
      text += "   ";
    }
    if (kind_ != TransformKind::rotate && component_count() > 1 &&
        (kind_ == TransformKind::translate || typing)) {
      text += std::string(names[i]) + " ";
    }
    if (typing && component == component_) {
      text += "[" + text_[component_] + "|]";
    } else {
      text += number(v);
    }
    text += kind_ == TransformKind::rotate ? "\u00b0" : "";
    ++component;
  }
  return text;
}

} // namespace cagewright::app
