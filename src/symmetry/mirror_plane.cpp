#include "symmetry/mirror_plane.h"

#include "core/maths.h"
#include "core/parallel.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>
#include <vector>

namespace cagewright {
namespace {

constexpr std::size_t few = 160;   // points to compare many planes
constexpr std::size_t some = 700;  // to refine a plane
constexpr std::size_t many = 4000; // to judge it
constexpr int directions = 220;    // over the half sphere: some 10 degrees apart
constexpr std::size_t finalists = 6;
/// Of the diagonal. Planes whose mean errors differ by less are equally good.
constexpr double even = 2e-4;
constexpr double thin = 0.05; // extent along the normal, of the diagonal
/// Of the diagonal. What is farther from the surface than this does not fit: how far it is takes
/// long to find out, and says nothing.
constexpr double astray = 0.08;

struct Plane {
  Vec3 normal = Vec3::UnitX();
  double offset = 0;
};

Vec3 mirrored(const Plane& plane, const Vec3& p) {
  return p - 2 * (plane.normal.dot(p) - plane.offset) * plane.normal;
}

struct Errors {
  double mean = 0;
  double high = 0;
};

double mean_of(std::span<const double> numbers) {
  double mean = 0;
  for (const double x : numbers) {
    mean += x / static_cast<double>(numbers.size());
  }
  return mean;
}

/// The surface in coordinates where its middle is the origin and its diagonal 1.
class Surface {
public:
  /// Not usable if it is to stop.
  Surface(TriangleView model, const Vec3& origin, const Progress& progress) {
    const Box3 box = bounding_box(model);
    diagonal_ = box.diagonal().norm();
    if (model.triangles.empty() || !(diagonal_ > 0) || !std::isfinite(diagonal_)) {
      return;
    }
    TriangleMesh mesh{{model.positions.begin(), model.positions.end()},
                      {model.triangles.begin(), model.triangles.end()}};
    to_unit(mesh.positions, box.center());
    std::vector<double> up_to; // summed areas
    Vec3 moment = Vec3::Zero();
    double area = 0;
    for (const Triangle& t : mesh.triangles) {
      const double part = area_of(mesh, t);
      area += part;
      up_to.push_back(area);
      moment += part * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    }
    if (!(area > 0)) {
      return;
    }
    const Vec3 middle = moment / area;
    for (Vec3& p : mesh.positions) {
      p -= middle;
    }
    center_ += diagonal_ * middle;
    box_center_ = -middle;
    world_origin_ = (origin - center_) / diagonal_;
    if (progress.cancelled()) {
      return;
    }
    for (const Triangle& t : mesh.triangles) {
      const double part = area_of(mesh, t);
      const Vec3 sum = mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]];
      covariance_ += part / 12 * sum * sum.transpose();
      for (const Index v : t) {
        covariance_ += part / 12 * mesh.positions[v] * mesh.positions[v].transpose();
        extent_.extend(mesh.positions[v]);
      }
    }
    covariance_ /= area;
    sample(mesh, up_to, area);
    if (progress.cancelled()) {
      return;
    }
    tree_ = TriangleBvh(mesh);
    usable_ = true;
  }

  [[nodiscard]] bool usable() const { return usable_; }
  [[nodiscard]] const Mat3& covariance() const { return covariance_; }
  [[nodiscard]] const Vec3& box_center() const { return box_center_; }
  [[nodiscard]] const Vec3& world_origin() const { return world_origin_; }
  [[nodiscard]] const TriangleBvh& tree() const { return tree_; }

  /// Points spread evenly over the surface; every beginning of the list is, too.
  [[nodiscard]] std::span<const Vec3> points(std::size_t count) const {
    return std::span(points_).first(std::min(count, points_.size()));
  }

  [[nodiscard]] double extent_along(const Vec3& normal) const {
    double low = 0;
    double high = 0;
    for (const Vec3& p : points(some)) {
      low = std::min(low, normal.dot(p));
      high = std::max(high, normal.dot(p));
    }
    return high - low;
  }

  /// Of the plane's mirror image of p from the surface; above `most` it counts as that.
  [[nodiscard]] double distance(const Plane& plane, const Vec3& p, double most) const {
    const NearestPoint found = tree_.nearest(mirrored(plane, p), most);
    return found ? found.distance : most;
  }

  /// Distances above `most` count as that.
  [[nodiscard]] Errors errors(const Plane& plane, std::size_t count,
                              double most = std::numeric_limits<double>::infinity()) const {
    const std::span<const Vec3> at = points(count);
    std::vector<double> d(at.size());
    parallel_for(0, at.size(), 64, [&](std::size_t i) { d[i] = distance(plane, at[i], most); });
    Errors e;
    e.mean = mean_of(d);
    const auto high = d.begin() + static_cast<std::ptrdiff_t>(d.size() * 99 / 100);
    std::nth_element(d.begin(), high, d.end());
    e.high = *high;
    return e;
  }

  [[nodiscard]] MirrorPlane to_model(const Plane& plane, const Errors& errors) const {
    MirrorPlane result;
    result.normal = plane.normal;
    result.offset = plane.offset * diagonal_ + plane.normal.dot(center_);
    constexpr double rounding = 1e-12;
    if (std::abs(result.offset) < rounding * diagonal_) {
      result.offset = 0; // it was meant to go through the origin
    }
    result.mean_error = errors.mean;
    result.high_error = errors.high;
    return result;
  }

private:
  static double area_of(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions[t[0]];
    const double area = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm() / 2;
    return std::isfinite(area) ? area : 0;
  }

  void to_unit(std::vector<Vec3>& positions, const Vec3& center) {
    center_ = center;
    for (Vec3& p : positions) {
      p = (p - center) / diagonal_;
    }
  }

  // By a sequence of low discrepancy (Roberts' R3: powers of the root of x^4 = x + 1), whose
  // beginnings are even as well.
  void sample(const TriangleMesh& mesh, const std::vector<double>& up_to, double area) {
    constexpr double root = 1.2207440846057596;
    points_.reserve(many);
    for (std::size_t i = 0; i < many; ++i) {
      const auto fraction = [&](double step) {
        const double x = 0.5 + step * static_cast<double>(i + 1);
        return x - std::floor(x);
      };
      const double target = fraction(1 / root) * area;
      const auto at = std::upper_bound(up_to.begin(), up_to.end() - 1, target) - up_to.begin();
      const Triangle& t = mesh.triangles[static_cast<std::size_t>(at)];
      double u = fraction(1 / (root * root));
      double v = fraction(1 / (root * root * root));
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const Vec3& a = mesh.positions[t[0]];
      points_.emplace_back(a + u * (mesh.positions[t[1]] - a) + v * (mesh.positions[t[2]] - a));
    }
  }

  double diagonal_ = 0;
  Vec3 center_ = Vec3::Zero(); // of the surface, in the model's coordinates
  Vec3 box_center_ = Vec3::Zero();
  Vec3 world_origin_ = Vec3::Zero();
  Mat3 covariance_ = Mat3::Zero();
  Box3 extent_;
  std::vector<Vec3> points_;
  TriangleBvh tree_;
  bool usable_ = false;
};

/// Two directions at right angles to n.
std::array<Vec3, 2> tangents(const Vec3& n) {
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Vec3 a = n.cross(Vec3::Unit(least)).normalized();
  return {a, n.cross(a)};
}

/// Turns and shifts the plane (or shifts it only) until the mirror images of the points come
/// nearest to the surface: iterated least squares of their distances along the directions to their
/// nearest points, in which distant pairs count less and less (Geman and McClure's weights). It
/// ends early where the mean distance hardly falls any more and is not `hopeful` yet.
Plane refined(const Surface& surface, Plane plane, bool turn, std::size_t count = some,
              double hopeful = std::numeric_limits<double>::infinity()) {
  const std::span<const Vec3> points = surface.points(count);
  std::vector<NearestPoint> nearest(points.size());
  std::vector<Vec3> images(points.size());
  constexpr int most_steps = 20;
  double damping = 1e-3;
  double before = std::numeric_limits<double>::infinity(); // the mean distance `patience` steps ago
  for (int step = 0; step < most_steps; ++step) {
    parallel_for(0, points.size(), 32, [&](std::size_t i) {
      images[i] = mirrored(plane, points[i]);
      nearest[i] = surface.tree().nearest(images[i], astray);
    });
    std::vector<double> distances(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      distances[i] = nearest[i] ? nearest[i].distance : astray;
    }
    constexpr int patience = 3;
    if (step % patience == 0) {
      const double mean = mean_of(distances);
      constexpr double progress = 0.97;
      if (mean > hopeful && mean > progress * before) {
        break;
      }
      before = mean;
    }
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    const double scale = std::max(3 * *middle, 1e-9);
    const auto [u, v] = tangents(plane.normal);
    Mat3 a = Mat3::Zero();
    Vec3 b = Vec3::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!nearest[i]) {
        continue;
      }
      const Vec3(&t)[3] = surface.tree().corners(nearest[i].triangle);
      const double d = nearest[i].distance;
      // Along the face's normal: the nearest point may slide on its face.
      const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
      const double length = normal.norm();
      if (!(length > 0)) {
        continue;
      }
      const Vec3 across = normal / length;
      const double residual = across.dot(images[i] - nearest[i].point);
      const double share = 1 / (1 + d * d / (scale * scale));
      const double weight = share * share;
      const double height = plane.normal.dot(points[i]) - plane.offset;
      const double along = across.dot(plane.normal);
      Vec3 slope(0, 0, 2 * along);
      if (turn) {
        slope[0] = -2 * (u.dot(points[i]) * along + height * across.dot(u));
        slope[1] = -2 * (v.dot(points[i]) * along + height * across.dot(v));
      }
      a += weight * slope * slope.transpose();
      b -= weight * residual * slope;
    }
    a += damping * a.trace() / 3 * Mat3::Identity() + 1e-30 * Mat3::Identity();
    damping = std::max(damping / 2, 1e-7);
    const Vec3 change = a.ldlt().solve(b);
    if (!change.allFinite()) {
      break;
    }
    constexpr double most_turn = 0.1;
    const double length = change.norm();
    const Vec3 taken = length > most_turn ? Vec3(change * (most_turn / length)) : change;
    if (turn) {
      plane.normal = (plane.normal + taken[0] * u + taken[1] * v).normalized();
    }
    plane.offset += taken[2];
    if (length < 1e-9) {
      break;
    }
  }
  return plane;
}

struct Judged {
  Plane plane;
  Errors errors;
};

Judged judged(const Surface& surface, const Plane& plane) {
  return {plane, surface.errors(plane, many)};
}

bool as_good(const Errors& candidate, const Errors& best) {
  return candidate.mean <= 1.05 * best.mean + even / 4 &&
         candidate.high <= 1.1 * best.high + 4 * even;
}

/// The same plane with rounder numbers, where that does as well: through the origin or the middle
/// of the model's box, across one of the world's axes.
Judged snapped(const Surface& surface, const Judged& found) {
  Judged best = found;
  Eigen::Index axis = 0;
  found.plane.normal.cwiseAbs().maxCoeff(&axis);
  Plane straight = found.plane;
  constexpr double near = 0.9994; // two degrees
  if (std::abs(found.plane.normal[axis]) > near) {
    straight.normal = Vec3::Unit(axis);
    straight.offset = found.plane.normal[axis] < 0 ? -found.plane.offset : found.plane.offset;
    straight = refined(surface, straight, false);
    const Judged tried = judged(surface, straight);
    if (!as_good(tried.errors, found.errors)) {
      return best;
    }
    best = tried;
  }
  constexpr double shift = 0.002;
  for (const Vec3& through : {surface.world_origin(), surface.box_center()}) {
    Plane moved = best.plane;
    moved.offset = moved.normal.dot(through);
    if (std::abs(moved.offset - best.plane.offset) < shift) {
      const Judged tried = judged(surface, moved);
      if (as_good(tried.errors, best.errors)) {
        return tried;
      }
    }
  }
  return best;
}

std::vector<Vec3> normals_to_try(const Surface& surface) {
  std::vector<Vec3> normals = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(surface.covariance());
  for (int k = 0; k < 3; ++k) {
    normals.emplace_back(principal.eigenvectors().col(k));
  }
  // A spiral over half of the sphere.
  for (int i = 0; i < directions; ++i) {
    const double z = (i + 0.5) / directions;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    normals.emplace_back(r * maths::cos(angle), r * maths::sin(angle), z);
  }
  return normals;
}

/// The best planes through the middle of the surface by a few points, each of a direction of its
/// own; none if cancelled. Points are asked only until others are known to be better: what they
/// have added up to is a lower bound of the error.
std::vector<Judged> most_promising(const Surface& surface, const Progress& progress) {
  struct Candidate {
    Plane plane;
    std::size_t number = 0;
    std::size_t asked = 0; // of the points
    double mean = 0;       // if the others' distances were 0

    // Of those that are even so far, one that may get worse comes first.
    bool operator<(const Candidate& other) const {
      return std::tuple(mean, asked, number) < std::tuple(other.mean, other.asked, other.number);
    }
  };
  std::vector<Candidate> candidates;
  for (const Vec3& normal : normals_to_try(surface)) {
    candidates.push_back({.plane = {normal, 0}, .number = candidates.size()});
  }
  const std::span<const Vec3> points = surface.points(few);
  constexpr std::size_t batch = 16; // of candidates
  constexpr std::size_t more = 20;  // points
  static_assert(few % more == 0);
  std::array<double, batch * more> distances;
  std::vector<Judged> best;
  while (best.size() < finalists && !candidates.empty()) {
    if (progress.cancelled()) {
      return {};
    }
    std::sort(candidates.begin(), candidates.end());
    if (const Candidate first = candidates.front(); first.asked == points.size()) {
      best.push_back({first.plane, {.mean = first.mean}});
      std::erase_if(candidates, [&](const Candidate& other) {
        constexpr double alike = 0.96; // cosine: 16 degrees
        return other.number == first.number ||
               std::abs(other.plane.normal.dot(first.plane.normal)) > alike;
      });
      continue;
    }
    std::vector<Candidate*> open;
    for (Candidate& candidate : candidates) {
      if (candidate.asked < points.size() && open.size() < batch) {
        open.push_back(&candidate);
      }
    }
    parallel_for(0, open.size() * more, 8, [&](std::size_t i) {
      const Candidate& candidate = *open[i / more];
      distances[i] = surface.distance(candidate.plane, points[candidate.asked + i % more], astray);
    });
    for (std::size_t i = 0; i < open.size() * more; ++i) {
      open[i / more]->mean += distances[i] / static_cast<double>(points.size());
    }
    for (Candidate* candidate : open) {
      candidate->asked += more;
    }
  }
  return best;
}

/// Which of two planes that do equally well is preferred: across x, y, z, any other; the thin last.
int rank(const Surface& surface, const Plane& plane) {
  Eigen::Index axis = 0;
  const double most = plane.normal.cwiseAbs().maxCoeff(&axis);
  constexpr double straight = 1 - 1e-9;
  const int place = most > straight ? static_cast<int>(axis) : 3;
  return place + (surface.extent_along(plane.normal) < thin ? 4 : 0);
}

MirrorPlane described(const Surface& surface, const Judged& best) {
  Plane plane = best.plane;
  Eigen::Index axis = 0;
  plane.normal.cwiseAbs().maxCoeff(&axis);
  if (plane.normal[axis] < 0) {
    plane = {-plane.normal, -plane.offset};
  }
  if (plane.normal[axis] == 1) {
    plane.normal = Vec3::Unit(axis);
  }
  return surface.to_model(plane, best.errors);
}

} // namespace

int MirrorPlane::axis() const {
  for (int k = 0; k < 3; ++k) {
    if (normal == Vec3::Unit(k)) {
      return k;
    }
  }
  return -1;
}

std::optional<MirrorPlane> detect_mirror_plane(TriangleView model, const MirrorOptions& options,
                                               const Progress& progress) {
  const Surface surface(model, options.origin, progress);
  if (!surface.usable()) {
    return std::nullopt;
  }
  std::vector<Judged> best = most_promising(surface, progress);
  if (best.empty()) {
    return std::nullopt;
  }
  // Most of them are far from anything: a few points show it.
  for (Judged& candidate : best) {
    if (progress.cancelled()) {
      return std::nullopt;
    }
    const Plane turned = refined(surface, candidate.plane, true, few);
    const Errors errors = surface.errors(turned, few, astray);
    if (errors.mean < candidate.errors.mean) {
      candidate = {turned, errors};
    }
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const Judged& a, const Judged& b) { return a.errors.mean < b.errors.mean; });
  const double hopeful = 1.5 * options.most_mean_error + even;
  const double hopeless =
      std::min(best.front().errors.mean + 3 * options.most_mean_error, 3 * hopeful);
  std::erase_if(best, [&](const Judged& candidate) { return candidate.errors.mean > hopeless; });
  std::optional<Judged> chosen;
  int chosen_rank = 0;
  for (const Judged& candidate : best) {
    if (progress.cancelled()) {
      return std::nullopt;
    }
    const Plane turned = refined(surface, candidate.plane, true, some, hopeful);
    if (std::min(candidate.errors.mean, surface.errors(turned, some, astray).mean) > hopeful) {
      continue;
    }
    Judged found = judged(surface, turned);
    if (candidate.errors.mean < found.errors.mean) { // led astray
      const Judged unturned = judged(surface, candidate.plane);
      found = unturned.errors.mean < found.errors.mean ? unturned : found;
    }
    if (found.errors.mean > 2 * options.most_mean_error + even) {
      continue; // no rounder numbers make it good
    }
    found = snapped(surface, found);
    const int place = rank(surface, found.plane);
    const bool better = !chosen || found.errors.mean < chosen->errors.mean - even ||
                        (found.errors.mean < chosen->errors.mean + even && place < chosen_rank);
    if (better) {
      chosen = found;
      chosen_rank = place;
    }
  }
  if (!chosen || chosen->errors.mean > options.most_mean_error ||
      chosen->errors.high > options.most_high_error) {
    return std::nullopt;
  }
  return described(surface, *chosen);
}

std::optional<MirrorPlane> best_mirror_plane(TriangleView model, int axis, const Vec3& origin,
                                             const Progress& progress) {
  const Surface surface(model, origin, progress);
  if (!surface.usable()) {
    return std::nullopt;
  }
  std::optional<Judged> best;
  const Vec3 normal = Vec3::Unit(axis);
  for (const Vec3& through : {surface.world_origin(), surface.box_center(), Vec3(Vec3::Zero())}) {
    if (progress.cancelled()) {
      return std::nullopt;
    }
    const double offset = normal.dot(through);
    if (std::abs(offset) > 0.5) {
      continue; // the model lies on one side of it
    }
    const Judged as_is = judged(surface, {normal, offset});
    const Judged moved = judged(surface, refined(surface, {normal, offset}, false));
    for (const Judged& candidate : {as_is, moved}) {
      if (!best || candidate.errors.mean < best->errors.mean - even / 4) {
        best = candidate;
      }
    }
  }
  return best ? std::optional(described(surface, *best)) : std::nullopt;
}

} // namespace cagewright
