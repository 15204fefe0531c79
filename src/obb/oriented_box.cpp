#include "obb/oriented_box.h"

#include "mesh/shapes.h"

#include <algorithm>

namespace cagewright {

std::array<Vec3, 8> OrientedBox::corners() const {
  std::array<Vec3, 8> result;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 sign((i & 1U) ? 1 : -1, (i & 2U) ? 1 : -1, (i & 4U) ? 1 : -1);
    result[i] = center + axes * half.cwiseProduct(sign);
  }
  return result;
}

bool OrientedBox::contains(const Vec3& p, double tolerance) const {
  return (to_local(p).cwiseAbs() - half).maxCoeff() <= tolerance;
}

OrientedBox OrientedBox::padded(double by) const {
  return {center, axes, half + Vec3::Constant(by)};
}

TriangleMesh to_mesh(const OrientedBox& box) {
  TriangleMesh mesh = make_cube();
  const std::array<Vec3, 8> corners = box.corners();
  std::copy(corners.begin(), corners.end(), mesh.positions.begin());
  return mesh;
}

OrientedBox box_in_frame(const Mat3& axes, std::span<const Vec3> points) {
  OrientedBox box;
  box.axes = axes;
  if (points.empty()) {
    return box;
  }
  // Relative to one of the points: far from the origin the projections keep their digits.
  const Vec3 origin = points.front();
  Box3 extent;
  for (const Vec3& p : points) {
    extent.extend(axes.transpose() * (p - origin));
  }
  box.center = origin + axes * extent.center();
  box.half = extent.sizes() / 2;
  return box;
}

OrientedBox sorted_by_length(const OrientedBox& box) {
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return box.half[a] > box.half[b]; });
  OrientedBox sorted = box;
  for (int i = 0; i < 3; ++i) {
    sorted.axes.col(i) = box.axes.col(order[i]);
    sorted.half[i] = box.half[order[i]];
  }
  if (sorted.axes.determinant() < 0) {
    sorted.axes.col(2) *= -1;
  }
  return sorted;
}

} // namespace cagewright
