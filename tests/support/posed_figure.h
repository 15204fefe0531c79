/// \file
/// A body with limbs whose left and right are known, though it is in a pose.
#pragma once

#include "core/rotation.h"
#include "mesh/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cagewright::test {

struct PosedFigure {
  TriangleMesh mesh;           ///< one closed piece
  std::vector<Index> partners; ///< of each vertex, left to right; in the middle, itself
};

/// A trunk with a head, a belly, two arms and two legs, its own mirror image in x = 0 until the
/// right arm is lifted, the left arm is taken forward, one leg is set before the other, and the
/// head is bent to a side.
///
/// \param by          all angles are times this: 0 leaves it its own mirror image
/// \param left_arm    its length is times this: 1 is that of the right arm
inline PosedFigure posed_figure(double by, int subdivisions, double left_arm = 1) {
  struct Limb {
    Vec3 along = Vec3::Zero(); // of length 1
    double length = 0;
    Vec3 axis = Vec3::Zero(); // that it bends about
    double angle = 0;
  };
  const std::array<Limb, 6> limbs = {{
      {Vec3(0.9, 0.35, 0).normalized(), 2.2, {0, 0, 1}, 0.7},
      {Vec3(-0.9, 0.35, 0).normalized(), 2.2 * left_arm, {0, 1, 0}, 0.7},
      {Vec3(0.45, -0.9, 0).normalized(), 2.6, {1, 0, 0}, -0.6},
      {Vec3(-0.45, -0.9, 0).normalized(), 2.6, {1, 0, 0}, 0.5},
      {Vec3(0, 1, 0), 1.2, {0, 0, 1}, 0.3},
      {Vec3(0, 0.1, 1).normalized(), 1.3, {0, 1, 0}, 0},
  }};
  constexpr double begins = 0.86; // a limb: the cosine of its half angle, seen from the middle
  const auto smooth = [](double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  PosedFigure figure{make_icosphere(subdivisions), {}};
  std::vector<Vec3>& at = figure.mesh.positions;
  for (const Vec3& p : at) {
    const auto image = std::ranges::min_element(
        at, {}, [&](const Vec3& q) { return (q - Vec3(-p.x(), p.y(), p.z())).squaredNorm(); });
    figure.partners.push_back(static_cast<Index>(image - at.begin()));
  }
  for (Vec3& p : at) {
    const Vec3 direction = p;
    for (const Limb& limb : limbs) {
      const double share = smooth((direction.dot(limb.along) - begins) / 0.1);
      p += limb.length * share * direction;
    }
    for (const Limb& limb : limbs) {
      const Vec3 joint = 1.4 * limb.along;
      const double beyond = (p - joint).dot(limb.along);
      constexpr double near = 0.9;
      if (direction.dot(limb.along) > begins) {
        p = joint +
            rotation_about(limb.axis, by * limb.angle * smooth(beyond / near)) * (p - joint);
      }
    }
  }
  return figure;
}

} // namespace cagewright::test
