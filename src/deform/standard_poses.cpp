#include <cagewright/deform/standard_poses.h>

#include "core/maths.h"
#include "core/parallel.h"
#include "core/rotation.h"
#include "deform/apply.h"
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace cagewright {
namespace {

constexpr double right_angle = std::numbers::pi / 2;
constexpr std::size_t tile_points = 16; // at once, as Coordinates takes them

Vec3 bent(const PoseFrame& frame, const Vec3& p) {
  const Vec3 offset = p - frame.center;
  const double s = offset.dot(frame.along);
  const double side = offset.dot(frame.toward);
  const double on_arc = std::clamp(s, -frame.length / 2, frame.length / 2);
  const double angle = right_angle * on_arc / frame.length;
  const double radius = frame.length / right_angle;
  const Vec3 tangent = maths::cos(angle) * frame.along + maths::sin(angle) * frame.toward;
  const Vec3 inward = maths::cos(angle) * frame.toward - maths::sin(angle) * frame.along;
  const Vec3 spine =
      radius * (maths::sin(angle) * frame.along + (1 - maths::cos(angle)) * frame.toward);
  const Vec3 across = offset - s * frame.along - side * frame.toward;
  return frame.center + spine + (s - on_arc) * tangent + side * inward + across;
}

Vec3 twisted(const PoseFrame& frame, const Vec3& p) {
  const Vec3 offset = p - frame.center;
  const double t = std::clamp(offset.dot(frame.along) / frame.length, -0.5, 0.5);
  return frame.center + rotation_about(frame.along, right_angle * t) * offset;
}

struct Sums {
  std::array<double, standard_poses.size()> sum = {};
  std::array<double, standard_poses.size()> max = {};
  PointCounts counts;
};

} // namespace

std::string_view name_of(StandardPose pose) {
  return pose == StandardPose::bend ? "bend" : "twist";
}

PoseFrame pose_frame(std::span<const Vec3> positions) {
  const Box3 box = bounding_box(positions);
  const Vec3 sizes = box.sizes();
  Eigen::Index longest = 0;
  Eigen::Index shortest = 0;
  for (Eigen::Index k = 1; k < 3; ++k) {
    longest = sizes[k] > sizes[longest] ? k : longest;
    shortest = sizes[k] <= sizes[shortest] ? k : shortest;
  }
  if (shortest == longest) { // a point
    shortest = 1;
  }
  PoseFrame frame;
  frame.center = box.center();
  frame.along = Vec3::Unit(longest);
  frame.toward = Vec3::Unit(shortest);
  frame.length = sizes[longest] > 0 ? sizes[longest] : 1;
  return frame;
}

Vec3 posed(StandardPose pose, const PoseFrame& frame, const Vec3& p) {
  return pose == StandardPose::bend ? bent(frame, p) : twisted(frame, p);
}

Result<PoseErrors> pose_errors(const PolygonMesh& cage, std::span<const Vec3> model,
                               CoordinateSettings settings, const Progress& progress) {
  settings.allow_open = true;
  const auto coordinates = prepare_coordinates(cage, settings, progress.part(0, 0.2));
  if (!coordinates) {
    return coordinates.error();
  }
  return pose_errors(**coordinates, model, progress.part(0.2, 1));
}

Result<PoseErrors> pose_errors(const Coordinates& coordinates, std::span<const Vec3> model,
                               const Progress& progress) {
  PoseErrors errors;
  const std::size_t columns = coordinates.columns();
  const PoseFrame frame = pose_frame(model);
  std::vector<PosedColumns> poses;
  for (const StandardPose kind : standard_poses) {
    std::vector<Vec3> pose;
    for (const Vec3& c : coordinates.rule()->cage_at_rest()) {
      pose.push_back(posed(kind, frame, c));
    }
    poses.emplace_back(*coordinates.rule(), pose);
    errors.followed[static_cast<std::size_t>(kind)].resize(model.size());
  }
  const std::size_t tiles = (model.size() + tile_points - 1) / tile_points;
  const Sums sums = parallel_reduce_ordered(
      0, tiles, 16, Sums(),
      [&](std::size_t first, std::size_t last) {
        Sums found;
        AlignedBuffer<double> weights(tile_points * columns);
        for (std::size_t t = first; t < last && !progress.cancelled(); ++t) {
          const auto points =
              model.subspan(t * tile_points, std::min(tile_points, model.size() - t * tile_points));
          found.counts.add(coordinates.solve(points, weights.span()));
          for (std::size_t k = 0; k < poses.size(); ++k) {
            const auto followed =
                std::span(errors.followed[k]).subspan(t * tile_points, points.size());
            move_sixteen(weights.span(), poses[k], points, followed);
            for (std::size_t i = 0; i < points.size(); ++i) {
              const double error =
                  (followed[i] - posed(standard_poses[k], frame, points[i])).norm();
              found.sum[k] += error;
              found.max[k] = std::max(found.max[k], error);
            }
          }
        }
        return found;
      },
      [](Sums& all, const Sums& part) {
        all.counts.add(part.counts);
        for (std::size_t k = 0; k < all.sum.size(); ++k) {
          all.sum[k] += part.sum[k];
          all.max[k] = std::max(all.max[k], part.max[k]);
        }
      });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  errors.undefined = sums.counts.undefined;
  errors.outside = sums.counts.outside;
  const double unit = diagonal(model);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double mean = sums.sum[k] / static_cast<double>(model.size());
    errors.of[k] = {unit > 0 ? mean / unit : 0, unit > 0 ? sums.max[k] / unit : 0};
  }
  return errors;
}

} // namespace cagewright
