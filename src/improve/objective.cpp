#include "improve/objective.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cagewright {

namespace {

// Exact for quadratic functions on the triangle (Strang and Fix, 1973).
struct Node {
  double weight;
  double at[3];
};
constexpr double near = 2.0 / 3;
constexpr double far = 1.0 / 6;
constexpr std::array<Node, 3> rule = {
    {{1.0 / 3, {near, far, far}}, {1.0 / 3, {far, near, far}}, {1.0 / 3, {far, far, near}}}};

double six_volumes(const Corners& t, const Vec3& origin) {
  return (t[0] - origin).dot((t[1] - origin).cross(t[2] - origin));
}

} // namespace

void set_emphasis(ObjectiveWeights& weights, TriangleView model, std::span<const double> density) {
  weights.emphasis.clear();
  weights.typical_emphasis = 1;
  if (density.empty()) {
    return;
  }
  constexpr double greatest_ratio = 100;
  const double least = *std::min_element(density.begin(), density.end());
  double area = 0;
  double sum = 0;
  for (const Triangle& t : model.triangles) {
    const double mean = (density[t[0]] + density[t[1]] + density[t[2]]) / 3;
    const double ratio = std::min(mean / least, greatest_ratio);
    weights.emphasis.push_back(ratio * ratio);
    const double a =
        triangle_area({model.positions[t[0]], model.positions[t[1]], model.positions[t[2]]});
    area += a;
    sum += a * ratio * ratio;
  }
  if (area > 0) {
    weights.typical_emphasis = sum / area;
  }
}

double triangle_area(const Corners& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
}

double shape_defect(const Corners& t) {
  const double sides =
      (t[1] - t[0]).squaredNorm() + (t[2] - t[1]).squaredNorm() + (t[0] - t[2]).squaredNorm();
  const double area = triangle_area(t);
  constexpr double most = 100;
  const double scaled = 4 * std::numbers::sqrt3 * area;
  return scaled * (most + good_shape) > sides ? std::max(0.0, sides / scaled - good_shape) : most;
}

double bend(const Corners& s, const Corners& t) {
  const Vec3 m = (s[1] - s[0]).cross(s[2] - s[0]);
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double length = m.norm() * n.norm();
  return length > 0 ? m.dot(n) / length : -1;
}

double Objective::face(const Corners& t) const {
  double sum = 0;
  for (const Node& node : rule) {
    const Vec3 p = node.at[0] * t[0] + node.at[1] * t[1] + node.at[2] * t[2];
    sum += node.weight * gap(nearest(p));
  }
  const double x = shape_defect(t);
  return triangle_area(t) * sum + shape_weight() * x * x + webbing(t) + tips(t);
}

double Objective::tips(const Corners& t) const {
  double sum = 0;
  if (weights_.tip > 0) {
    for (const Vec3& p : t) {
      sum += tip_weight() * maths::square(beyond_near(nearest(p).distance));
    }
  }
  return sum;
}

double Objective::sampled_gap(const Corners& t) const {
  double greatest = 0;
  constexpr int cells = 4;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; i + j <= cells; ++j) {
      const Vec3 p = (i * t[0] + j * t[1] + (cells - i - j) * t[2]) / cells;
      greatest = std::max(greatest, nearest(p).distance);
    }
  }
  return greatest;
}

bool Objective::widens_gap(const CageMesh& cage, const Patch& patch) const {
  if (!std::isfinite(weights_.most_gap)) {
    return false;
  }
  double gap = 0;
  for (const Triangle& t : patch.added) {
    gap = std::max(gap, sampled_gap(corners_after(cage, patch, t)));
  }
  if (gap <= weights_.most_gap) {
    return false;
  }
  double before = 0;
  for (const Index f : patch.removed) {
    before = std::max(before, sampled_gap(corners_of(cage, f)));
  }
  constexpr double progress = 0.8;
  return gap > progress * before;
}

bool Objective::widens_gap(const Corners& before, const Corners& after) const {
  if (!std::isfinite(weights_.most_gap)) {
    return false;
  }
  const double gap = sampled_gap(after);
  return gap > weights_.most_gap && gap > sampled_gap(before);
}

Vec3 volume_origin(const CageMesh& cage, const Vec3& nearby) {
  return cage.is_half() ? Vec3(0, nearby.y(), nearby.z()) : nearby;
}

double Objective::volume_change(const CageMesh& cage, const Patch& patch) {
  const Vec3 origin = volume_origin(cage, cage.position(cage.face(patch.removed[0])[0]));
  double sum = 0;
  for (const Index f : patch.removed) {
    sum -= six_volumes(corners_of(cage, f), origin);
  }
  for (const Triangle& t : patch.added) {
    sum += six_volumes(corners_after(cage, patch, t), origin);
  }
  return sum / 6;
}

double Objective::change(const CageMesh& cage, std::span<const double> face_values,
                         const Patch& patch) const {
  double sum = volume_change(cage, patch);
  for (const Index f : patch.removed) {
    sum -= face_values[f];
  }
  for (const Triangle& t : patch.added) {
    sum += face(corners_after(cage, patch, t));
  }
  return sum;
}

std::vector<double> Objective::face_values(const CageMesh& cage, const Progress& progress) const {
  std::vector<double> values(cage.face_end(), 0);
  parallel_for(0, values.size(), 1, progress, [&](std::size_t f) {
    if (cage.has_face(static_cast<Index>(f))) {
      values[f] = face(corners_of(cage, static_cast<Index>(f)));
    }
  });
  return values;
}

double Objective::total(const CageMesh& cage) const {
  const Vec3 origin = volume_origin(cage, cage.position(0));
  double sum = 0;
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (cage.has_face(f)) {
      const Corners t = corners_of(cage, f);
      sum += six_volumes(t, origin) / 6 + face(t);
    }
  }
  return sum;
}

} // namespace cagewright
