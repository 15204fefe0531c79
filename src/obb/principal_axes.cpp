#include "obb/principal_axes.h"

#include <cagewright/mesh/measures.h>

#include <Eigen/Eigenvalues>

#include <cmath>

namespace cagewright {
namespace {

// Differences below this are taken for round-off: of variances relative to the greatest, of the
// components of unit vectors.
constexpr double equal_within = 1e-6;

// Of the entries, the index of the greatest; the first of those that are equal.
int first_greatest(const Vec3& entries) {
  const double least = entries.maxCoeff() - equal_within;
  return entries[0] >= least ? 0 : entries[1] >= least ? 1 : 2;
}

Vec3 with_positive_main_component(const Vec3& axis) {
  return axis[first_greatest(axis.cwiseAbs())] < 0 ? Vec3(-axis) : axis;
}

// The unit vector perpendicular to `normal` that is nearest to a world axis.
Vec3 world_axis_in_plane(const Vec3& normal) {
  const Mat3 projected = Mat3::Identity() - normal * normal.transpose();
  return projected.col(first_greatest(projected.colwise().norm().transpose())).normalized();
}

// Right-handed axes by falling variance from eigenvectors by falling eigenvalue.
Mat3 settled_axes(const Vec3& variances, const Mat3& eigenvectors) {
  const bool first_two = variances[0] - variances[1] <= equal_within * variances[0];
  const bool last_two = variances[1] - variances[2] <= equal_within * variances[0];
  if (first_two && last_two) {
    return Mat3::Identity();
  }
  Mat3 axes = eigenvectors;
  if (first_two) {
    axes.col(0) = world_axis_in_plane(axes.col(2));
    axes.col(1) = axes.col(2).cross(axes.col(0));
  } else if (last_two) {
    axes.col(1) = world_axis_in_plane(axes.col(0));
  }
  axes.col(0) = with_positive_main_component(axes.col(0));
  axes.col(1) = with_positive_main_component(axes.col(1));
  axes.col(2) = axes.col(0).cross(axes.col(1)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

} // namespace

PrincipalAxes principal_axes(std::span<const Vec3> points) {
  PrincipalAxes result;
  const Box3 box = bounding_box(points);
  if (box.isEmpty()) {
    return result;
  }
  // About the middle of the box and in units of its longest edge the sums neither lose digits far
  // from the origin nor overflow.
  const Vec3 origin = box.center();
  const double unit = box.sizes().maxCoeff() > 0 ? box.sizes().maxCoeff() : 1;
  const double n = static_cast<double>(points.size());
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) {
    sum += (p - origin) / unit;
  }
  const Vec3 mean = sum / n;
  Mat3 squares = Mat3::Zero();
  for (const Vec3& p : points) {
    const Vec3 d = (p - origin) / unit - mean;
    squares += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(squares / n);
  const Vec3 variances = solver.eigenvalues().reverse().cwiseMax(0.0);
  result.mean = origin + unit * mean;
  result.covariance = squares / n * (unit * unit);
  result.variances = variances * (unit * unit);
  result.axes = settled_axes(variances, solver.eigenvectors().rowwise().reverse());
  return result;
}

OrientedBox pca_box(std::span<const Vec3> points) {
  return box_in_frame(principal_axes(points).axes, points);
}

} // namespace cagewright
