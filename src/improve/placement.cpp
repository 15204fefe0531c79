#include "improve/placement.h"

#include "improve/nearest_in_half_spaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace cagewright {

namespace {

// Constraints ask for a little more than the clearance, so that a step on curved constraints ends
// on the right side.
constexpr double margin = 1.02;
constexpr int most_rounds = 12;
// How often the objective is taken anew at a better place.
constexpr int refreshes = 2;

struct Quadratic {
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

Vec3 unit_normal(const Corners& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
}

// The vertex w and the triangles (w, a, b) round it.
class Fan {
public:
  Fan(const Guard& guard, const Objective& objective, const CageMesh& cage, Patch& patch)
      : guard_(guard), objective_(objective), patch_(patch) {
    const Ring ring = ring_of(patch);
    for (const auto& [a, b] : ring) {
      from_.push_back(cage.position(a));
      to_.push_back(cage.position(b));
      const Index outer = cage.face_left_of(b, a);
      outer_normal_.push_back(outer != no_index ? unit_normal(corners_of(cage, outer))
                                                : Vec3(Vec3::Zero()));
      on_boundary_.push_back(cage.on_plane(a) && cage.on_plane(b));
    }
    for (const Index f : patch.removed) {
      for (const Vec3& p : corners_of(cage, f)) {
        old_.push_back(p);
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return from_.size(); }

  [[nodiscard]] Corners corners(std::size_t i) const { return {patch_.position, from_[i], to_[i]}; }

  // The objective to second order round the present position: the volume is linear in it, the gap
  // is taken along the direction to the nearest point of the model. With `contacts` it adds half
  // spaces that keep those points clear of the model.
  [[nodiscard]] Quadratic objective(std::vector<HalfSpace>* contacts = nullptr) const {
    Quadratic q;
    const Vec3& w = patch_.position;
    double patch_area = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const Corners t = corners(i);
      q.gradient += (t[1] - w).cross(t[2] - w) / 6;
      add_gap(q, t, contacts);
      add_shape(q, t);
      patch_area += triangle_area(t);
    }
    // Far steps leave the model of the objective: they cost as much as their volume at D / 10.
    q.hessian += (4 * patch_area / objective_.diagonal()) * Mat3::Identity();
    return q;
  }

  // Half spaces for all faces above which there is some of the model. \returns how many
  int add_blocked(std::vector<HalfSpace>& spaces) const {
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < size(); ++i) {
      normals.push_back(unit_normal(corners(i)));
    }
    int count = 0;
    const double keep = margin * guard_.clearance();
    for (std::size_t i = 0; i < size(); ++i) {
      const auto top = highest_above(i, normals);
      if (!top) {
        continue;
      }
      // (w, a, b) must pass above the point, raised by the clearance.
      const Vec3 raised = top->point + keep * normals[i] - from_[i];
      const Vec3 normal = raised.cross(to_[i] - from_[i]);
      const double length = normal.norm();
      if (length > 1e-6 * (to_[i] - from_[i]).squaredNorm()) {
        spaces.push_back({normal / length, normal.dot(from_[i]) / length});
        ++count;
      }
    }
    return count;
  }

  // A half space that drives the face apart from the pair. \returns false if w has no say in it
  bool add_separation(std::vector<HalfSpace>& spaces, const ClosestPoints& pair) const {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < size(); ++i) {
      const double d =
          point_triangle_distance(pair.on_a, corners(i)[0], corners(i)[1], corners(i)[2]);
      if (d < least) {
        least = d;
        nearest = i;
      }
    }
    const Corners t = corners(nearest);
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double share =
        (t[2] - t[1]).cross(pair.on_a - t[1]).dot(n) / std::max(n.squaredNorm(), 1e-300);
    constexpr double least_share = 0.02;
    if (share < least_share) {
      return false;
    }
    const Vec3 away = pair.distance > 0.01 * guard_.clearance()
                          ? Vec3((pair.on_a - pair.on_b) / pair.distance)
                          : Vec3(n.normalized());
    const double push = (margin * guard_.clearance() - pair.distance) / share;
    spaces.push_back({-away, -away.dot(patch_.position) - push});
    return true;
  }

  // Where the vertex may be, however tight the budget: no farther beyond the model than this, or
  // than the old faces.
  [[nodiscard]] Box3 room() const {
    constexpr double beyond = 0.25; // of the diagonal
    const ModelSurface& model = guard_.model();
    const Vec3 more = Vec3::Constant(beyond * model.diagonal + 2 * guard_.clearance());
    Box3 box(model.box.min() - more, model.box.max() + more);
    for (const Vec3& p : old_) {
      box.extend(p);
    }
    return box;
  }

private:
  void add_gap(Quadratic& q, const Corners& t, std::vector<HalfSpace>* contacts) const {
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = n.norm() / 2;
    if (area <= 0) {
      return;
    }
    double mean = 0;
    for (int k = 0; k < 3; ++k) {
      const double share = k == 0 ? 2.0 / 3 : 1.0 / 6;
      const Vec3 p = (t[0] + t[1] + t[2]) / 6 + t[k] / 2;
      const SurfaceTree::Nearest near = objective_.nearest(p);
      const double d = near.distance;
      mean += objective_.gap(near) / 3;
      if (d > 0) {
        const Vec3 u = (p - near.point) / d;
        q.gradient += area / 3 * share * objective_.gap_slope(near) * u;
        q.hessian += area / 3 * share * share * objective_.gap_curvature(near) * u * u.transpose();
        if (contacts != nullptr) {
          const double room = std::max(0.0, d - margin * guard_.clearance());
          contacts->push_back({-u, room / share - u.dot(patch_.position)});
        }
      }
    }
    q.gradient += mean / 2 * (n / (2 * area)).cross(t[2] - t[1]); // the area changes too
  }

  void add_shape(Quadratic& q, const Corners& t) const {
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = n.norm() / 2;
    const double x = shape_defect(t);
    const double scaled = 4 * std::numbers::sqrt3 * area;
    if (!(scaled > 0) || x == 0) {
      return;
    }
    const Vec3 area_slope = (n / (2 * area)).cross(t[2] - t[1]) / 2;
    const Vec3 slope = 2 * (2 * t[0] - t[1] - t[2]) / scaled - (x + good_shape) / area * area_slope;
    const double weight = objective_.shape_weight();
    q.gradient += 2 * weight * x * slope;
    q.hessian += 2 * weight * (x * 4 / scaled * Mat3::Identity() + slope * slope.transpose());
  }

  // What of the model is above face i and was below the old faces. Between two faces of the fan
  // the space is divided by the plane that bisects their angle.
  [[nodiscard]] std::optional<SurfaceTree::Highest>
  highest_above(std::size_t i, const std::vector<Vec3>& normals) const {
    const Corners t = corners(i);
    const Vec3& n = normals[i];
    const HalfSpace plane{n, n.dot(t[0])};
    double most = 0;
    for (const Vec3& p : old_) {
      most = std::max(most, plane.above(p));
    }
    const bool open = patch_.on_plane;
    const std::array<Vec3, 3> beside = {
        open && i == 0 ? mirrored(n) : normals[(i + size() - 1) % size()],
        on_boundary_[i] ? mirrored(n) : outer_normal_[i],
        open && i + 1 == size() ? mirrored(n) : normals[(i + 1) % size()]};
    std::array<HalfSpace, 3> sides;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = t[(k + 1) % 3] - t[k];
      Vec3 across = n + beside[k];
      if (across.squaredNorm() < 0.1) {
        across = n;
      }
      Vec3 normal = edge.cross(across).normalized();
      if (normal.dot(edge.cross(n)) < 0) {
        normal = -normal;
      }
      sides[k] = {normal, normal.dot(t[k])};
    }
    constexpr double error = 0.2; // any of the higher points will do: there will be another round
    return objective_.model().tree.highest(plane, sides, -guard_.clearance(), most, error);
  }

  const Guard& guard_;
  const Objective& objective_;
  Patch& patch_;
  std::vector<Vec3> from_;
  std::vector<Vec3> to_;
  std::vector<Vec3> outer_normal_; // of the faces across a b
  std::vector<bool> on_boundary_;  // a b is an edge of one face, on a half's plane
  std::vector<Vec3> old_;          // corners of the removed faces
};

// The best step from the origin, with half spaces relative to it. With `in_plane` there is no step
// along x.
std::optional<Vec3> best_step(Quadratic q, std::vector<HalfSpace> spaces, bool in_plane) {
  if (in_plane) {
    q.gradient.x() = 0;
    q.hessian.row(0).setZero();
    q.hessian.col(0).setZero();
    q.hessian(0, 0) = q.hessian(1, 1) + q.hessian(2, 2);
    std::size_t kept = 0;
    for (HalfSpace s : spaces) {
      s.normal.x() = 0;
      const double length = s.normal.norm();
      constexpr double parallel = 1e-6;
      if (length > parallel) {
        spaces[kept++] = {s.normal / length, s.offset / length};
      } else if (s.offset < 0) {
        return std::nullopt;
      }
    }
    spaces.resize(kept);
  }
  std::optional<Vec3> step = minimize_in_half_spaces(q.hessian, q.gradient, spaces);
  if (step && in_plane) {
    step->x() = 0;
  }
  return step;
}

std::optional<Vec3> solve(const Quadratic& q, const Vec3& origin,
                          const std::vector<HalfSpace>& spaces, bool in_plane) {
  std::vector<HalfSpace> moved = spaces;
  for (HalfSpace& s : moved) {
    s.offset -= s.normal.dot(origin);
  }
  const std::optional<Vec3> step = best_step(q, std::move(moved), in_plane);
  return step ? std::optional<Vec3>(origin + *step) : std::nullopt;
}

// The band's two half spaces, for places relative to the origin.
void add_band(const SeamBand& band, const Vec3& origin, std::vector<HalfSpace>& spaces) {
  const double middle = band.normal.dot(band.point - origin);
  spaces.push_back({band.normal, band.half_width + middle});
  spaces.push_back({-band.normal, band.half_width - middle});
}

// The place in the band nearest to p, with `in_plane` of those with the same x. None: there is
// none.
std::optional<Vec3> nearest_in_band(const SeamBand& band, const Vec3& p, bool in_plane) {
  const Vec3 nearest = band.nearest(p);
  if (!in_plane || nearest == p) {
    return nearest;
  }
  const Vec3 across(0, band.normal.y(), band.normal.z());
  constexpr double parallel = 1e-6;
  if (across.norm() < parallel) {
    return std::nullopt;
  }
  return p + (band.height(nearest) - band.height(p)) / across.squaredNorm() * across;
}

// Half spaces for the sides of the box that the place is beyond. \returns whether there are any
bool add_sides_passed(const Box3& box, const Vec3& place, std::vector<HalfSpace>& spaces) {
  constexpr double rounding = 1e-9;
  const double slack = rounding * box.diagonal().norm();
  const std::size_t before = spaces.size();
  for (int k = 0; k < 3; ++k) {
    if (place[k] > box.max()[k] + slack) {
      spaces.push_back({Vec3::Unit(k), box.max()[k]});
    } else if (place[k] < box.min()[k] - slack) {
      spaces.push_back({-Vec3::Unit(k), -box.min()[k]});
    }
  }
  return spaces.size() > before;
}

} // namespace

std::optional<Vec3> place_clear_of_model(const Guard& guard, const Objective& objective,
                                         const CageMesh& cage, Patch patch) {
  const Fan fan(guard, objective, cage, patch);
  std::vector<HalfSpace> spaces;
  if (cage.is_half() && !patch.on_plane) {
    const double off_plane = plane_gap * guard.clearance();
    patch.position.x() = std::max(patch.position.x(), off_plane);
    spaces.push_back({-Vec3::UnitX(), -off_plane});
  }
  if (const SeamBand* band = cage.band_of(patch)) {
    const std::optional<Vec3> inside = nearest_in_band(*band, patch.position, patch.on_plane);
    if (!inside) {
      return std::nullopt;
    }
    patch.position = *inside;
    add_band(*band, Vec3::Zero(), spaces);
  }
  const Box3 room = fan.room();
  std::optional<Vec3> best;
  Quadratic quadratic = fan.objective();
  Vec3 origin = patch.position;
  int taken = 1;
  for (int round = 0; round < most_rounds; ++round) {
    if (fan.add_blocked(spaces) == 0) {
      const std::optional<ClosestPoints> pair = guard.too_near(cage, patch);
      const bool is_out = !pair && add_sides_passed(room, patch.position, spaces);
      if (!pair && !is_out) {
        const bool settled = best && (*best - patch.position).norm() < guard.clearance() / 4;
        best = patch.position;
        if (taken == refreshes || settled) {
          return best;
        }
        quadratic = fan.objective();
        origin = patch.position;
        ++taken;
      } else if (pair && !fan.add_separation(spaces, *pair)) {
        return best;
      }
    }
    const std::optional<Vec3> next = solve(quadratic, origin, spaces, patch.on_plane);
    if (!next) {
      return best;
    }
    patch.position = *next;
  }
  return best;
}

double promised_gain(const Guard& guard, const Objective& objective, const CageMesh& cage,
                     Patch patch) {
  const Fan fan(guard, objective, cage, patch);
  std::vector<HalfSpace> contacts;
  const Quadratic q = fan.objective(&contacts);
  const std::optional<Vec3> place = solve(q, patch.position, contacts, patch.on_plane);
  if (!place) {
    return 0;
  }
  const Vec3 step = *place - patch.position;
  return -(q.gradient.dot(step) + 0.5 * step.dot(q.hessian * step));
}

std::optional<Vec3> place_outside_patch(const CageMesh& cage, const Patch& patch) {
  const Vec3 origin = patch.position;
  Quadratic q;
  std::vector<HalfSpace> outside;
  double area = 0;
  for (const Index f : patch.removed) {
    const Corners t = corners_of(cage, f);
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double length = n.norm();
    if (length > 0) {
      const Vec3 unit = n / length;
      const double height = unit.dot(origin - t[0]);
      outside.push_back({-unit, height});
      q.gradient += length / 2 * height * unit;
      q.hessian += length / 2 * unit * unit.transpose();
      area += length / 2;
    }
  }
  if (cage.is_half() && !patch.on_plane) { // no nearer to the plane than the nearest was
    double least = origin.x();
    for (const Index f : patch.removed) {
      for (const Index v : cage.face(f)) {
        least = cage.on_plane(v) ? least : std::min(least, cage.position(v).x());
      }
    }
    outside.push_back({-Vec3::UnitX(), origin.x() - least});
  }
  if (const SeamBand* band = cage.band_of(patch)) {
    add_band(*band, origin, outside);
  }
  // The volume decides; the distance from the planes of the old faces keeps the vertex near.
  const double size = std::sqrt(area);
  q.gradient /= size;
  q.hessian = q.hessian / size + 0.05 * area / size * Mat3::Identity();
  for (const auto& [a, b] : ring_of(patch)) {
    q.gradient += (cage.position(a) - origin).cross(cage.position(b) - origin) / 6;
  }
  const std::optional<Vec3> step = best_step(q, std::move(outside), patch.on_plane);
  return step ? std::optional<Vec3>(origin + *step) : std::nullopt;
}

} // namespace cagewright
