/// \file
/// The principal axes of points, and the oriented box along them.
#pragma once

#include "obb/oriented_box.h"
#include <cagewright/core/geometry.h>

#include <span>

namespace cagewright {

/// The second-order shape of N points x_1 .. x_N.
struct PrincipalAxes {
  Vec3 mean = Vec3::Zero();       ///< m = 1/N sum x_i
  Mat3 covariance = Mat3::Zero(); ///< 1/N sum (x_i - m)(x_i - m)^T: of the population, not a sample
  Vec3 variances = Vec3::Zero();  ///< the covariance's eigenvalues, falling
  Mat3 axes = Mat3::Identity();   ///< its eigenvectors in that order, right-handed
};

/// Principal axes of the points. For no points, the default.
///
/// An eigenvector is known only up to its sign, and where eigenvalues coincide (within 1e-6 of the
/// greatest) only their common eigenspace is. So the sign is that which makes the component of
/// greatest magnitude positive, save for the third axis, which completes a right-handed frame; and
/// within a common eigenspace the axes are those nearest to the world's. Cubes and spheres thus get
/// the world's axes, and moved or scaled copies of a shape get the same axes.
///
/// Cost: O(N).
PrincipalAxes principal_axes(std::span<const Vec3> points);

/// The tight box of the points along their principal axes, in the order of falling variance (which
/// is not always that of falling length: see sorted_by_length). Its center is the middle of the
/// extremes, not the mean: {-5, 4, 4, 5} has center 0.
OrientedBox pca_box(std::span<const Vec3> points);

} // namespace cagewright
