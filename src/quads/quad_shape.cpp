#include "quads/quad_shape.h"

#include "core/maths.h"
#include "improve/objective.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

double angle_between(const Vec3& m, const Vec3& n) {
  return maths::atan2(m.cross(n).norm(), m.dot(n)) * degrees;
}

Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a);
}

} // namespace

QuadShape shape_of(const QuadCorners& q) {
  QuadShape shape;
  const Vec3 area = (q[2] - q[0]).cross(q[3] - q[1]);
  const double length = area.norm();
  if (!(length > 0)) {
    return shape;
  }
  const Vec3 n = area / length;
  shape.bend_degrees =
      std::max(angle_between(normal_of(q[0], q[1], q[2]), normal_of(q[0], q[2], q[3])),
               angle_between(normal_of(q[1], q[2], q[3]), normal_of(q[1], q[3], q[0])));
  shape.quality = 1;
  shape.min_angle_degrees = 360;
  shape.max_angle_degrees = 0;
  for (int i = 0; i < 4; ++i) {
    shape.quality = std::min(shape.quality, shape_quality({q[(i + 3) % 4], q[i], q[(i + 1) % 4]}));
    Vec3 next = q[(i + 1) % 4] - q[i];
    Vec3 last = q[(i + 3) % 4] - q[i];
    next -= next.dot(n) * n;
    last -= last.dot(n) * n;
    double angle = maths::atan2(next.cross(last).dot(n), next.dot(last)) * degrees;
    angle = angle < 0 ? angle + 360 : angle;
    shape.min_angle_degrees = std::min(shape.min_angle_degrees, angle);
    shape.max_angle_degrees = std::max(shape.max_angle_degrees, angle);
  }
  return shape;
}

QuadCorners corners_of(std::span<const Vec3> positions, const CageFace& quad) {
  return {positions[quad[0]], positions[quad[1]], positions[quad[2]], positions[quad[3]]};
}

CageFace along_shorter_diagonal(std::span<const Vec3> positions, const CageFace& face) {
  if (!face.is_quad()) {
    return face;
  }
  const QuadCorners q = corners_of(positions, face);
  return (q[1] - q[3]).squaredNorm() < (q[0] - q[2]).squaredNorm() ? face.turned(1) : face;
}

void split_unfit(QuadCage& cage, const QuadLimits& limits) {
  for (Index f = 0; f < cage.face_end(); ++f) {
    const CageFace face = cage.face(f);
    if (face.is_quad()) {
      const QuadCorners q = corners_of(cage.positions(), face);
      if (face.tentative || !shape_of(q).within(limits)) {
        const bool second =
            !face.tentative && (q[1] - q[3]).squaredNorm() < (q[0] - q[2]).squaredNorm();
        const int k = second ? 1 : 0;
        cage.replace(
            std::array{f},
            std::array{CageFace::triangle(face[k], face[k + 1], face[k + 2]).of_part(face.part),
                       CageFace::triangle(face[k], face[k + 2], face[k + 3]).of_part(face.part)});
      }
    }
  }
}

Vec3 area_vector(std::span<const Vec3> positions, const CageFace& face) {
  if (face.is_quad()) {
    return (positions[face[2]] - positions[face[0]]).cross(positions[face[3]] - positions[face[1]]);
  }
  return normal_of(positions[face[0]], positions[face[1]], positions[face[2]]);
}

double face_defect(std::span<const Vec3> positions, const CageFace& face,
                   const FaceWishes& wishes) {
  if (!face.is_quad()) {
    constexpr double needles = 0.5;
    return wishes.lone +
           needles * shape_defect({positions[face[0]], positions[face[1]], positions[face[2]]});
  }
  const QuadCorners q = corners_of(positions, face);
  const QuadShape shape = shape_of(q);
  QuadLimits limits = wishes.limits;
  limits.max_bend_degrees += wishes.beyond;
  limits.max_angle_degrees += wishes.beyond;
  limits.min_angle_degrees -= wishes.beyond / 4;
  limits.min_quality = wishes.beyond > 0 ? 0 : limits.min_quality;
  if (!shape.within(limits)) {
    return unfit;
  }
  const auto off_square = [](double angle) { return maths::square((angle - 90) / 45); };
  const auto side = [&](int i) { return (q[(i + 1) % 4] - q[i]).norm(); };
  const double stretch = maths::log((side(0) + side(2)) / (side(1) + side(3)));
  return wishes.angle *
             (off_square(shape.min_angle_degrees) + off_square(shape.max_angle_degrees)) +
         wishes.bend * maths::square(shape.bend_degrees / 20) + wishes.stretch * stretch * stretch;
}

} // namespace cagewright
