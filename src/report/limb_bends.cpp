#include "report/limb_bends.h"

#include "core/maths.h"
#include "core/parallel.h"
#include "core/rotation.h"
#include "deform/apply.h"
#include "envelope/envelope.h"
#include "mesh/solid_angle.h"
#include "report/json.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace cagewright {
namespace {

constexpr double full_angle = std::numbers::pi / 4;
constexpr std::size_t tile_points = 16; // at once, as Coordinates takes them

/// An envelope made for so many vertices shows the limbs that are worth a joint.
constexpr int vertices_for_limbs = 300;

/// A limb bent in one direction.
struct Pose {
  std::size_t limb = 0;
  int direction = 0;
  PosedColumns columns;
  std::vector<Vec3> cage; ///< where its vertices go
};

/// Sums over vertices, for one pose.
struct Sums {
  double error = 0;
  double max = 0;
  double drag = 0;
  double max_drag = 0;
  std::size_t moved = 0;
  std::size_t rest = 0;
};

void add(std::vector<Sums>& all, const std::vector<Sums>& part) {
  for (std::size_t k = 0; k < part.size(); ++k) {
    all[k].error += part[k].error;
    all[k].max = std::max(all[k].max, part[k].max);
    all[k].drag += part[k].drag;
    all[k].max_drag = std::max(all[k].max_drag, part[k].max_drag);
    all[k].moved += part[k].moved;
    all[k].rest += part[k].rest;
  }
}

bool is_inside(const Vec3& p, std::span<const Triangle> triangles, std::span<const Vec3> cage) {
  double angle = 0;
  for (const Triangle& t : triangles) {
    angle += solid_angle(p, cage[t[0]], cage[t[1]], cage[t[2]]);
  }
  return std::abs(angle) > 2 * std::numbers::pi;
}

/// Bends a cage at all limbs, and sums up what becomes of the model.
class Bends {
public:
  Bends(const Coordinates& coordinates, TriangleView cage, std::span<const Vec3> model,
        const BendableLimbs& limbs)
      : coordinates_(coordinates), cage_(cage), model_(model), limbs_(limbs),
        unit_(std::max(diagonal(model), 1e-300)) {
    const auto rest = coordinates.rule()->cage_at_rest();
    for (std::size_t limb = 0; limb < limbs.count(); ++limb) {
      shares_.push_back(limbs.shares(limb, model));
      const std::vector<double> of_cage = limbs.shares(limb, rest);
      for (int direction = 0; direction < BendableLimbs::directions; ++direction) {
        std::vector<Vec3> posed;
        for (std::size_t c = 0; c < rest.size(); ++c) {
          posed.push_back(limbs.bent(limb, direction, rest[c], of_cage[c]));
        }
        PosedColumns columns(*coordinates.rule(), posed);
        poses_.push_back({limb, direction, std::move(columns), std::move(posed)});
      }
    }
  }

  [[nodiscard]] Result<std::vector<LimbBendError>> errors(const Progress& progress) const {
    const std::size_t tiles = (model_.size() + tile_points - 1) / tile_points;
    const std::vector<Sums> sums = parallel_reduce_ordered(
        0, tiles, 16, std::vector<Sums>(poses_.size()),
        [&](std::size_t first, std::size_t last) { return summed_up(first, last, progress); }, add);
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    std::vector<LimbBendError> errors(limbs_.count());
    constexpr double share = 1.0 / BendableLimbs::directions;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      LimbBendError& error = errors[poses_[k].limb];
      const Sums& sum = sums[k];
      const double moved = static_cast<double>(std::max<std::size_t>(1, sum.moved));
      const double rest = static_cast<double>(std::max<std::size_t>(1, sum.rest));
      error.mean += share * sum.error / moved / unit_;
      error.max = std::max(error.max, sum.max / unit_);
      error.drag += share * sum.drag / rest / unit_;
      error.max_drag = std::max(error.max_drag, sum.max_drag / unit_);
      error.moved = sum.moved;
    }
    look_closely(errors, progress);
    return progress.cancelled() ? Result<std::vector<LimbBendError>>(Error::cancelled()) : errors;
  }

private:
  [[nodiscard]] std::vector<Sums> summed_up(std::size_t first, std::size_t last,
                                            const Progress& progress) const {
    std::vector<Sums> sums(poses_.size());
    AlignedBuffer<double> weights(tile_points * coordinates_.columns());
    std::array<Vec3, tile_points> followed;
    for (std::size_t t = first; t < last && !progress.cancelled(); ++t) {
      const std::size_t begin = t * tile_points;
      const auto points = model_.subspan(begin, std::min(tile_points, model_.size() - begin));
      coordinates_.solve(points, weights.span());
      for (std::size_t k = 0; k < poses_.size(); ++k) {
        const Pose& pose = poses_[k];
        move_sixteen(weights.span(), pose.columns, points,
                     std::span(followed).first(points.size()));
        for (std::size_t i = 0; i < points.size(); ++i) {
          const double turned = shares_[pose.limb][begin + i];
          const Vec3 wanted = limbs_.bent(pose.limb, pose.direction, points[i], turned);
          count((followed[i] - wanted).norm(), turned > 0, sums[k]);
        }
      }
    }
    return sums;
  }

  static void count(double off, bool is_moved, Sums& sums) {
    (is_moved ? sums.error : sums.drag) += off;
    double& max = is_moved ? sums.max : sums.max_drag;
    max = std::max(max, off);
    ++(is_moved ? sums.moved : sums.rest);
  }

  /// Of some vertices of each limb: how far its end turns, and which leave the cage.
  void look_closely(std::vector<LimbBendError>& errors, const Progress& progress) const {
    constexpr std::size_t most = 800;
    const auto rest = coordinates_.rule()->cage_at_rest();
    parallel_for(0, limbs_.count(), 1, progress, [&](std::size_t limb) {
      std::vector<std::size_t> members;
      for (std::size_t v = 0; v < model_.size(); ++v) {
        if (shares_[limb][v] > 0 && is_finite(model_[v])) {
          members.push_back(v);
        }
      }
      const std::size_t step = members.size() / most + 1;
      std::vector<Vec3> points;
      std::vector<double> turned;
      for (std::size_t i = 0; i < members.size(); i += step) {
        if (is_inside(model_[members[i]], cage_.triangles, rest)) {
          points.push_back(model_[members[i]]);
          turned.push_back(shares_[limb][members[i]]);
        }
      }
      for (const Pose& pose : poses_) {
        if (pose.limb == limb && !points.empty()) {
          look_at(pose, points, turned, errors[limb]);
        }
      }
    });
  }

  static bool is_finite(const Vec3& p) { return p.allFinite(); }

  void look_at(const Pose& pose, std::span<const Vec3> points, std::span<const double> turned,
               LimbBendError& error) const {
    const std::vector<Vec3> followed = follow(pose, points);
    constexpr double share = 1.0 / BendableLimbs::directions;
    std::size_t left = 0;
    for (const Vec3& p : followed) {
      left += is_inside(p, cage_.triangles, pose.cage) ? 0 : 1;
    }
    error.left += share * static_cast<double>(left) / static_cast<double>(points.size());
    error.reached += share * angle_reached(pose, points, followed, turned);
  }

  [[nodiscard]] std::vector<Vec3> follow(const Pose& pose, std::span<const Vec3> points) const {
    std::vector<Vec3> followed(points.size());
    AlignedBuffer<double> weights(tile_points * coordinates_.columns());
    for (std::size_t begin = 0; begin < points.size(); begin += tile_points) {
      const auto some = points.subspan(begin, std::min(tile_points, points.size() - begin));
      coordinates_.solve(some, weights.span());
      move_sixteen(weights.span(), pose.columns, some,
                   std::span(followed).subspan(begin, some.size()));
    }
    return followed;
  }

  /// Of the rotation in the plane of the bend that takes what is beyond it nearest to where it
  /// went: in degrees, as if all of it had been turned by the whole angle.
  [[nodiscard]] double angle_reached(const Pose& pose, std::span<const Vec3> points,
                                     std::span<const Vec3> followed,
                                     std::span<const double> turned) const {
    // Of a limb that is too short for the whole angle, its end.
    const double most = *std::max_element(turned.begin(), turned.end());
    const auto is_end = [&](std::size_t i) { return turned[i] >= 0.98 * most; };
    Vec3 before = Vec3::Zero();
    Vec3 after = Vec3::Zero();
    double count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (is_end(i)) {
        before += points[i];
        after += followed[i];
        ++count;
      }
    }
    const Vec3 axis = limbs_.axis(pose.limb, pose.direction);
    double sine = 0;
    double cosine = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (is_end(i)) {
        const Vec3 a = points[i] - before / count;
        const Vec3 b = followed[i] - after / count;
        sine += axis.dot(a.cross(b));
        cosine += a.dot(b) - axis.dot(a) * axis.dot(b);
      }
    }
    return maths::atan2(sine, cosine) * 180 / std::numbers::pi / most;
  }

  const Coordinates& coordinates_;
  TriangleView cage_;
  std::span<const Vec3> model_;
  const BendableLimbs& limbs_;
  double unit_;
  std::vector<std::vector<double>> shares_; // of the model's vertices, by limb
  std::vector<Pose> poses_;
};

} // namespace

Result<BendableLimbs> BendableLimbs::of(TriangleView model, std::span<const LimbJoint> joints,
                                        const Progress& progress) {
  EnvelopeOptions options;
  options.vertices = vertices_for_limbs;
  const Result<Envelope> made = envelope(model, options, progress);
  if (!made) {
    return made.error();
  }
  BendableLimbs limbs;
  limbs.limbs_ = find_limbs(made->mesh, limb_cuts(model, progress), vertices_for_limbs, joints);
  limbs.envelope_ = TriangleBvh(made->mesh);
  for (const Limb& limb : limbs.limbs_) {
    std::vector<std::uint8_t>& is_of = limbs.is_of_limb_.emplace_back(made->mesh.triangles.size());
    for (const Index f : limb.faces) {
      is_of[f] = 1;
    }
  }
  return limbs;
}

std::vector<double> BendableLimbs::shares(std::size_t number, std::span<const Vec3> points) const {
  constexpr double near = 0.75; // widths
  const Limb& limb = limbs_[number];
  std::vector<double> shares(points.size(), 0);
  parallel_for(0, points.size(), 256, [&](std::size_t i) {
    const Vec3 offset = points[i] - limb.joint.position;
    const double t = std::clamp(offset.dot(limb.joint.along) / limb.width + 0.5, 0.0, 1.0);
    if (t > 0 && (offset.norm() < near * limb.width ||
                  is_of_limb_[number][envelope_.nearest(points[i]).triangle] != 0)) {
      shares[i] = t * t * (3 - 2 * t);
    }
  });
  return shares;
}

Vec3 BendableLimbs::axis(std::size_t number, int direction) const {
  const Vec3& along = limbs_[number].joint.along;
  Eigen::Index least = 0;
  along.cwiseAbs().minCoeff(&least);
  const Vec3 first = along.cross(Vec3::Unit(least)).normalized();
  const Vec3 axis = direction % 2 == 0 ? first : Vec3(along.cross(first));
  return direction < 2 ? axis : Vec3(-axis);
}

Vec3 BendableLimbs::bent(std::size_t number, int direction, const Vec3& p, double share) const {
  if (share == 0) {
    return p;
  }
  const Vec3& center = limbs_[number].joint.position;
  return center + rotation_about(axis(number, direction), share * full_angle) * (p - center);
}

Result<std::vector<LimbBendError>> limb_bend_errors(const Coordinates& coordinates,
                                                    TriangleView cage, std::span<const Vec3> model,
                                                    const BendableLimbs& limbs,
                                                    const Progress& progress) {
  return Bends(coordinates, cage, model, limbs).errors(progress);
}

LimbBendError summed(std::span<const LimbBendError> errors) {
  LimbBendError sum;
  for (const LimbBendError& error : errors) {
    const double share = 1.0 / static_cast<double>(errors.size());
    sum.mean += share * error.mean;
    sum.max = std::max(sum.max, error.max);
    sum.drag += share * error.drag;
    sum.max_drag = std::max(sum.max_drag, error.max_drag);
    sum.reached += share * error.reached;
    sum.left += share * error.left;
    sum.moved += error.moved;
  }
  return sum;
}

nlohmann::json json_of(const BendableLimbs& limbs, std::span<const LimbBendError> errors) {
  const auto figures = [](const LimbBendError& error) -> nlohmann::json {
    return {{"mean_error", error.mean},
            {"max_error", error.max},
            {"drag", error.drag},
            {"max_drag", error.max_drag},
            {"reached_degrees", error.reached},
            {"left_the_cage", error.left},
            {"vertices", error.moved}};
  };
  nlohmann::json json = figures(summed(errors));
  json["limbs"] = nlohmann::json::array();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    nlohmann::json limb = figures(errors[i]);
    limb["joint"] = json_of(limbs.limb(i).joint.position);
    limb["along"] = json_of(limbs.limb(i).joint.along);
    limb["width"] = limbs.limb(i).width;
    json["limbs"].push_back(std::move(limb));
  }
  return json;
}

} // namespace cagewright
