#include <cagewright/render/camera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace cagewright {
namespace {

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// Along one side of the frame: the range of points seen, sheared so that the planes that bound
/// the view through the eye at distance 0 become lines of constant value.
struct Reach {
  double low = -std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double offset, double depth, double slope) {
    low = std::max(low, depth - offset / slope);
    high = std::max(high, depth + offset / slope);
  }
  [[nodiscard]] double center(double slope) const { return (high - low) * slope / 2; }
  [[nodiscard]] double distance() const { return (high + low) / 2; }
};

/// Shifts the camera sideways until the picture is as far from the frame's left as from its right,
/// and likewise from top and bottom. The nearer a point, the more it shifts: hence in steps, each
/// of which leaves about a fifth of the error.
void center_picture(Camera& camera, const std::vector<Vec3>& points) {
  for (int step = 0; step < 8; ++step) {
    Eigen::AlignedBox2d picture;
    for (const Vec3& point : points) {
      const Vec3 p = camera.axes * point - camera.eye;
      picture.extend(Eigen::Vector2d(p.x(), p.y()) / -p.z());
    }
    const double middle_depth = (camera.nearest + camera.farthest) / 2;
    camera.eye.head<2>() += picture.center() * middle_depth;
  }
}

} // namespace

Mat3 view_axes(const View& view, UpAxis up) {
  const double yaw = radians(view.yaw_degrees);
  const double pitch = radians(view.pitch_degrees);
  // In a frame where y is up and the model faces z.
  const Vec3 right(std::cos(yaw), 0, -std::sin(yaw));
  const Vec3 backward(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                      std::cos(yaw) * std::cos(pitch));
  Mat3 axes;
  axes.row(0) = right;
  axes.row(1) = backward.cross(right);
  axes.row(2) = backward;
  if (up == UpAxis::z) { // y of that frame is z of the model, z of it is -y
    const Mat3 y_up = axes;
    axes.col(1) = -y_up.col(2);
    axes.col(2) = y_up.col(1);
  }
  return axes;
}

std::optional<View> view_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, View>, 8> names = {{
      {"front", {0, 0}},
      {"back", {180, 0}},
      {"left", {-90, 0}},
      {"right", {90, 0}},
      {"side", {90, 0}},
      {"top", {0, 90}},
      {"bottom", {0, -90}},
      {"three-quarter", {35, 15}},
  }};
  for (const auto& [known, view] : names) {
    if (known == name) {
      return view;
    }
  }
  return std::nullopt;
}

Camera fitted_camera(const View& view, UpAxis up, double angle_degrees, double aspect,
                     double margin, const std::vector<Vec3>& points) {
  Camera camera;
  camera.axes = view_axes(view, up);
  camera.tan_half_height = std::tan(radians(angle_degrees) / 2);

  const double slope_y = camera.tan_half_height * (1 - 2 * margin);
  const double slope_x = camera.tan_half_height * aspect * (1 - 2 * margin);
  Reach across;
  Reach upward;
  double front = -std::numeric_limits<double>::infinity();
  double rear = std::numeric_limits<double>::infinity();
  const auto add = [&](const Vec3& point) {
    const Vec3 p = camera.axes * point;
    across.add(p.x(), p.z(), slope_x);
    upward.add(p.y(), p.z(), slope_y);
    front = std::max(front, p.z());
    rear = std::min(rear, p.z());
  };
  std::for_each(points.begin(), points.end(), add);
  if (points.empty()) {
    add(Vec3::Zero());
  }

  // A little away from what would otherwise touch the eye: a flat sheet seen from its edge.
  const double depth = std::max(front - rear, 0.01);
  const double distance = std::max({across.distance(), upward.distance(), front + 0.1 * depth});
  camera.eye = {across.center(slope_x), upward.center(slope_y), distance};
  camera.nearest = std::max(distance - front - 0.05 * depth, 0.02 * depth);
  camera.farthest = distance - rear + 0.05 * depth;
  if (!points.empty()) {
    center_picture(camera, points);
  }
  return camera;
}

} // namespace cagewright
