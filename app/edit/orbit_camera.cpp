#include "app/edit/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace cagewright::app {
namespace {

// Tangent of half the angle of view: 30 degrees from the bottom to the top.
const double tan_half_height = std::tan(15 * std::acos(-1.0) / 180);
constexpr double zoom_step = 1.2;

/// Radius of a box about its middle; 1 for one that has none.
double radius_of(const Box3& box) {
  const double radius = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
  return radius > 0 && std::isfinite(radius) ? radius : 1;
}

} // namespace

void OrbitCamera::resize(double width, double height) {
  width_ = std::max(width, 1.0);
  height_ = std::max(height, 1.0);
}

void OrbitCamera::orbit(const Pixel& drag) {
  const double degrees = 180 / std::max(height_, 1.0);
  view_.yaw_degrees = std::remainder(view_.yaw_degrees - drag.x() * degrees, 360.0);
  view_.pitch_degrees = std::clamp(view_.pitch_degrees + drag.y() * degrees, -90.0, 90.0);
}

void OrbitCamera::pan(const Pixel& drag) {
  const Mat3 a = axes();
  const double size = pixel_size(target_);
  target_ += size * (-drag.x() * a.row(0) + drag.y() * a.row(1)).transpose();
}

void OrbitCamera::zoom(double steps, const Pixel& cursor) {
  const Vec3 before = at_depth_of(target_, cursor);
  const double radius = radius_of(scene_);
  distance_ = std::clamp(distance_ * std::pow(zoom_step, -steps), 1e-4 * radius, 1e3 * radius);
  target_ += before - at_depth_of(target_, cursor);
}

void OrbitCamera::frame(const Box3& box) {
  if (box.isEmpty()) {
    return;
  }
  target_ = box.center();
  const double slope_y = tan_half_height;
  const double slope_x = tan_half_height * width_ / height_;
  const Mat3 a = axes();
  double needed = 0; // so that no corner is beyond the frame
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 v = a * (box.corner(static_cast<Box3::CornerType>(corner)) - target_);
    needed =
        std::max({needed, v.z() + std::abs(v.x()) / slope_x, v.z() + std::abs(v.y()) / slope_y});
  }
  distance_ = needed > 0 ? 1.12 * needed : 0.1 * radius_of(scene_);
}

void OrbitCamera::look(StandardView view) {
  switch (view) {
  case StandardView::front:
    view_ = {0, 0};
    break;
  case StandardView::back:
    view_ = {180, 0};
    break;
  case StandardView::right:
    view_ = {90, 0};
    break;
  case StandardView::left:
    view_ = {-90, 0};
    break;
  case StandardView::top:
    view_ = {0, 90};
    break;
  case StandardView::bottom:
    view_ = {0, -90};
    break;
  }
}

void OrbitCamera::look_opposite() {
  view_.yaw_degrees = std::remainder(view_.yaw_degrees + 180, 360.0);
  view_.pitch_degrees = -view_.pitch_degrees;
}

void OrbitCamera::restore(const Vec3& target, double distance, const View& view, bool perspective) {
  if (target.allFinite() && std::isfinite(distance) && distance > 0 &&
      std::isfinite(view.yaw_degrees) && std::isfinite(view.pitch_degrees)) {
    target_ = target;
    distance_ = distance;
    view_ = {std::remainder(view.yaw_degrees, 360.0), std::clamp(view.pitch_degrees, -90.0, 90.0)};
  }
  perspective_ = perspective;
}

Vec3 OrbitCamera::eye() const {
  return target_ + distance_ * axes().row(2).transpose();
}

Vec3 OrbitCamera::to_viewer(const Vec3& p) const {
  return perspective_ ? (eye() - p).normalized() : Vec3(axes().row(2));
}

double OrbitCamera::half_height() const {
  return perspective_ ? tan_half_height : tan_half_height * distance_;
}

Ray OrbitCamera::ray(const Pixel& pixel) const {
  const Mat3 a = axes();
  const double x = (2 * pixel.x() - width_) / height_ * half_height();
  const double y = (height_ - 2 * pixel.y()) / height_ * half_height();
  if (perspective_) {
    return {eye(), (a.transpose() * Vec3(x, y, -1)).normalized()};
  }
  // Far enough back to be before everything.
  const double back =
      scene_.isEmpty()
          ? distance_
          : std::max(distance_, 2 * radius_of(scene_) + (scene_.center() - target_).norm());
  return {target_ + a.transpose() * Vec3(x, y, back), -a.row(2).transpose()};
}

std::optional<Projected> OrbitCamera::project(const Vec3& p) const {
  const Vec3 v = axes() * (p - eye());
  const double depth = -v.z();
  if (perspective_ && !(depth > 1e-9 * distance_)) {
    return std::nullopt;
  }
  const double scale = height_ / (2 * half_height() * (perspective_ ? depth : 1.0));
  return Projected{{width_ / 2 + v.x() * scale, height_ / 2 - v.y() * scale}, depth};
}

Vec3 OrbitCamera::at_depth_of(const Vec3& p, const Pixel& pixel) const {
  const Ray sight = ray(pixel);
  const Vec3 backward = axes().row(2);
  return sight.at((p - sight.origin).dot(backward) / sight.direction.dot(backward));
}

double OrbitCamera::pixel_size(const Vec3& p) const {
  const double depth =
      perspective_ ? std::max(std::abs((eye() - p).dot(axes().row(2))), 1e-9 * distance_) : 1.0;
  return 2 * half_height() * depth / height_;
}

Eigen::Vector2d OrbitCamera::depth_range() const {
  const Box3 box =
      scene_.isEmpty() ? Box3(Vec3(target_.array() - 1), Vec3(target_.array() + 1)) : scene_;
  const double radius = 1.05 * radius_of(box);
  const double middle = (eye() - box.center()).dot(axes().row(2));
  const double farthest = middle + radius;
  if (!perspective_) {
    return {middle - radius, farthest};
  }
  const double least = std::max(farthest, distance_) * 2e-4;
  return {std::max(middle - radius, least), std::max(farthest, 2 * least)};
}

Eigen::Matrix4d OrbitCamera::clip_matrix(const Vec3& center, double scale) const {
  const Mat3 a = axes();
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = a / scale;
  view.topRightCorner<3, 1>() = a * (center - eye());
  const Eigen::Vector2d range = depth_range();
  const double near = range[0];
  const double far = range[1];
  const double h = half_height();
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = height_ / (width_ * h);
  projection(1, 1) = 1 / h;
  if (perspective_) {
    projection(2, 2) = (far + near) / (near - far);
    projection(2, 3) = 2 * far * near / (near - far);
    projection(3, 2) = -1;
  } else {
    projection(2, 2) = 2 / (near - far);
    projection(2, 3) = (far + near) / (near - far);
    projection(3, 3) = 1;
  }
  return projection * view;
}

} // namespace cagewright::app
