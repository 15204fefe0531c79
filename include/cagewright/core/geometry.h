/// \file
/// Points, vectors and axis-aligned boxes: aliases of Eigen's, the field's common tongue.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cagewright {

/// A point or a vector: three packed doubles, so that std::span<const Vec3> is also a flat xyz
/// array.
using Vec3 = Eigen::Vector3d;
/// Three columns: of an orthonormal frame, its axes.
using Mat3 = Eigen::Matrix3d;
/// An axis-aligned box; the default one is empty.
using Box3 = Eigen::AlignedBox3d;

static_assert(sizeof(Vec3) == 3 * sizeof(double));

} // namespace cagewright
