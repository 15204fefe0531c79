// Mean value weights of those parts of the cage that the point sees.
//
// A face that is seen from inside can be hidden only where the line of sight leaves the cage and
// comes back through a face that is seen from outside. The shadow of such a face is cut out of it
// as far as it lies in front: what is left are convex pieces, cut into triangles, for which the
// mean value integral is known in closed form. Faces do not cross, so one look at the middle tells
// which of two lies in front.

#include <cagewright/coordinates/positive_mean_value.h>

#include "coordinates/surface_coordinates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <hwy/highway.h>

#include "coordinates/view_angles-inl.h"

namespace cagewright {
namespace {

namespace scalar = HWY_NAMESPACE;

/// Corners of a convex polygon, as seen from the point: it is the origin.
using Polygon = std::vector<Vec3>;

/// A cone of directions round those to a face.
struct Cap {
  Vec3 axis;
  double cosine = -1;
  double sine = 0;

  [[nodiscard]] bool meets(const Cap& other) const {
    // The angle of the axes against the sum of the two angles.
    const double both = cosine * other.cosine - sine * other.sine;
    const bool is_wide = sine * other.cosine + cosine * other.sine <= 0; // their sum exceeds pi
    return is_wide || axis.dot(other.axis) >= both - 1e-12;
  }
};

Cap cap_of(const std::array<Vec3, 3>& corners) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : corners) {
    middle += p.normalized();
  }
  if (middle.norm() < 1e-6) { // all round the point
    return {Vec3::UnitX(), -1, 0};
  }
  Cap cap{middle.normalized(), 1, 0};
  for (const Vec3& p : corners) {
    cap.cosine = std::min(cap.cosine, cap.axis.dot(p) / p.norm());
  }
  if (cap.cosine <= 0) { // the widest place need no longer be a corner
    cap.cosine = -1;
  }
  cap.sine = std::sqrt(std::max(0.0, 1 - cap.cosine * cap.cosine));
  return cap;
}

/// The parts of a convex polygon on either side of a plane through the origin.
struct Halves {
  Polygon inside, outside;
};

Halves split(const Polygon& polygon, const Vec3& plane) {
  Halves halves;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double at_a = plane.dot(a);
    const double at_b = plane.dot(b);
    (at_a >= 0 ? halves.inside : halves.outside).push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) {
      const Vec3 between = a + at_a / (at_a - at_b) * (b - a);
      halves.inside.push_back(between);
      halves.outside.push_back(between);
    }
  }
  return halves;
}

double twice_area(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return sum.norm();
}

/// A face that is seen from outside, and may hide others.
struct Blocker {
  std::array<Vec3, 3> planes; ///< of its edges and the point; positive inside its shadow
  Vec3 normal;
  double offset = 0; ///< normal . p on it
  Cap cap;
  std::array<Vec3, 3> corners;
};

class Views {
public:
  Views(const Surface& surface, const scalar::PointTerms& point)
      : surface_(surface), point_(point) {
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      if (point.face(f).height < 0) {
        add_blocker(f);
      }
    }
  }

  /// Adds the weights of the corners of a face that is seen from inside.
  void add(std::size_t f, std::vector<double>& weights) const {
    const Surface::Face& face = surface_.faces[f];
    const std::vector<const Blocker*> blockers = blockers_of(f);
    if (blockers.empty()) {
      double whole[3];
      scalar::view_weights_of(surface_, point_, f, whole);
      for (std::size_t k = 0; k < 3; ++k) {
        weights[face.vertices[k]] += whole[k];
      }
      return;
    }
    const std::array<Vec3, 3> corners = corners_of(f);
    std::vector<Polygon> pieces = {Polygon(corners.begin(), corners.end())};
    for (const Blocker* blocker : blockers) {
      std::vector<Polygon> left;
      for (const Polygon& piece : pieces) {
        cut(piece, *blocker, left);
      }
      pieces = std::move(left);
    }
    for (const Polygon& piece : pieces) {
      add_piece(f, piece, weights);
    }
  }

private:
  [[nodiscard]] std::array<Vec3, 3> corners_of(std::size_t f) const {
    const std::array<Index, 3>& v = surface_.faces[f].vertices;
    return {point_.to_vertex(v[0]), point_.to_vertex(v[1]), point_.to_vertex(v[2])};
  }

  void add_blocker(std::size_t f) {
    Blocker blocker;
    blocker.corners = corners_of(f);
    for (std::size_t e = 0; e < 3; ++e) { // its corners run clockwise as they are seen
      blocker.planes[e] = blocker.corners[(e + 1) % 3].cross(blocker.corners[e]);
    }
    blocker.normal = surface_.faces[f].normal;
    blocker.offset = point_.face(f).height;
    blocker.cap = cap_of(blocker.corners);
    blockers_.push_back(blocker);
  }

  [[nodiscard]] std::vector<const Blocker*> blockers_of(std::size_t f) const {
    std::vector<const Blocker*> found;
    if (blockers_.empty()) {
      return found;
    }
    const std::array<Vec3, 3> corners = corners_of(f);
    const Cap cap = cap_of(corners);
    std::array<Vec3, 3> planes;
    for (std::size_t e = 0; e < 3; ++e) {
      planes[e] = corners[e].cross(corners[(e + 1) % 3]);
    }
    const auto all_outside = [](const Vec3& plane, const std::array<Vec3, 3>& points) {
      return plane.dot(points[0]) <= 0 && plane.dot(points[1]) <= 0 && plane.dot(points[2]) <= 0;
    };
    const Vec3& normal = surface_.faces[f].normal;
    const double height = point_.face(f).height;
    for (const Blocker& blocker : blockers_) {
      if (!cap.meets(blocker.cap)) {
        continue;
      }
      const bool is_behind = std::ranges::all_of(
          blocker.corners, [&](const Vec3& p) { return normal.dot(p) >= height; });
      const bool is_apart =
          std::ranges::any_of(blocker.planes,
                              [&](const Vec3& plane) { return all_outside(plane, corners); }) ||
          std::ranges::any_of(
              planes, [&](const Vec3& plane) { return all_outside(plane, blocker.corners); });
      if (!is_behind && !is_apart) {
        found.push_back(&blocker);
      }
    }
    return found;
  }

  /// Appends what the blocker leaves of a piece.
  static void cut(const Polygon& piece, const Blocker& blocker, std::vector<Polygon>& left) {
    constexpr double no_area = 1e-28;
    Polygon shadow = piece;
    std::vector<Polygon> outside;
    for (const Vec3& plane : blocker.planes) {
      Halves halves = split(shadow, plane);
      shadow = std::move(halves.inside);
      if (halves.outside.size() >= 3 && twice_area(halves.outside) > no_area) {
        outside.push_back(std::move(halves.outside));
      }
    }
    bool hides = shadow.size() >= 3 && twice_area(shadow) > no_area;
    if (hides) {
      Vec3 middle = Vec3::Zero();
      for (const Vec3& p : shadow) {
        middle += p / static_cast<double>(shadow.size());
      }
      const double along = blocker.normal.dot(middle);
      const double share = blocker.offset / along; // of the way to the middle
      hides = share > 0 && share < 1;
    }
    if (!hides) {
      left.push_back(piece);
      return;
    }
    std::ranges::move(outside, std::back_inserter(left));
  }

  /// The same integral over a polygon that is part of face f: hats are those of the face.
  void add_piece(std::size_t f, const Polygon& corners, std::vector<double>& weights) const {
    const Surface::Face& face = surface_.faces[f];
    const double height = point_.face(f).height;
    Vec3 across = Vec3::Zero(); // sum of A_e nu_e
    double sigma = 0;
    double careful = 0;
    bool is_above = true; // the point's projection lies in the polygon
    for (std::size_t e = 0; e < corners.size(); ++e) {
      const Vec3& from = corners[e];
      const Vec3& to = corners[(e + 1) % corners.size()];
      const double length = (to - from).norm();
      if (!(length > 1e-150)) {
        continue;
      }
      const Vec3 along = (to - from) / length;
      const Vec3 outward = along.cross(face.normal);
      const double rho = outward.dot(from);
      const double tau = along.dot(from);
      const double line = std::max(std::sqrt(rho * rho + height * height), 1e-150);
      const scalar::EdgeView<double> view{scalar::angle_of(length * line, from.dot(to)), line, tau,
                                          tau + length};
      across += view.angle / line * outward;
      sigma += rho * view.angle / line;
      careful += scalar::careful_part(view, rho, height);
      is_above = is_above && rho >= 0;
    }
    if (std::abs(height) < scalar::near_plane) {
      sigma = careful + (is_above ? scalar::full_angle / 2 : 0);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 gradient = -face.share[i] * face.outward[(i + 1) % 3];
      weights[face.vertices[i]] +=
          point_.face(f).lambda[i] * sigma / (2 * height) - height / 2 * gradient.dot(across);
    }
  }

  const Surface& surface_;
  const scalar::PointTerms& point_;
  std::vector<Blocker> blockers_;
};

class PositiveMeanValueCoordinates : public SurfaceCoordinates {
public:
  PositiveMeanValueCoordinates(const PolygonMesh& cage, Surface surface, OutsideTreatment outside)
      : SurfaceCoordinates(vertex_columns(cage.positions), std::move(surface), outside) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    TileReport report;
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::vector<double> own = solve_one(points[i], static_cast<std::uint16_t>(1U << i), report);
      scalar::put_vertices_of(surface(), own, weights, stride, i);
    }
    return report;
  }

  [[nodiscard]] std::vector<double> solve_one(const Vec3& x, std::uint16_t bit,
                                              TileReport& report) const {
    std::vector<double> weights(surface().positions.size(), 0.0);
    if (!scalar::is_usable(x)) {
      report.undefined |= bit;
      return weights;
    }
    const scalar::PointTerms point(surface(), x);
    const scalar::PointPlace place = scalar::place_of(surface(), point);
    if (place.on_surface) {
      report.on_surface |= bit;
      for (const auto& [vertex, hat] : place.hats) {
        weights[vertex] += hat;
      }
      return weights;
    }
    if (place.outside) {
      report.outside |= bit;
      return weights;
    }
    const Views views(surface(), point);
    for (std::size_t f = 0; f < surface().faces.size(); ++f) {
      if (point.face(f).height > 0) {
        views.add(f, weights);
      }
    }
    if (!normalize(x, weights)) {
      report.undefined |= bit;
      std::ranges::fill(weights, 0.0);
    }
    return weights;
  }

  /// \returns whether they then reproduce the point: they do but where the cage crosses itself
  [[nodiscard]] bool normalize(const Vec3& x, std::vector<double>& weights) const {
    constexpr double rounding = 1e-15; // slivers that cutting has left of what is hidden
    constexpr double reproduced = 1e-9;
    const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = 0;
    for (double& w : weights) {
      w = w > rounding * whole ? w : 0;
      sum += w;
    }
    Vec3 off = Vec3::Zero();
    for (std::size_t v = 0; v < weights.size(); ++v) {
      weights[v] /= sum;
      off += weights[v] * (surface().positions[v] - x);
    }
    return off.norm() < reproduced; // not where there is nothing to be seen: that is no number
  }
};

constexpr std::array<const CoordinateOption*, 2> kind_options = {&quads_option, &outside_option};

Result<std::shared_ptr<const Coordinates>>
prepare_kind(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  const Result<OutsideTreatment> outside = outside_without_continuation(settings);
  if (!outside) {
    return outside.error();
  }
  return positive_mean_value_coordinates(
      cage,
      {.quads = static_cast<QuadTreatment>(settings.choice(quads_option)), .outside = *outside});
}

} // namespace

Result<std::shared_ptr<const Coordinates>>
positive_mean_value_coordinates(const PolygonMesh& cage, const PositiveMeanValueOptions& options) {
  Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  return std::shared_ptr<const Coordinates>(
      std::make_shared<PositiveMeanValueCoordinates>(cage, *std::move(surface), options.outside));
}

constinit const CoordinateKind positive_mean_value_kind = {
    .name = "positive_mean_value",
    .idea = "mean value of what the point sees: nothing is dragged by what lies across a gap",
    .quads = "center or diagonal",
    .sign = "not negative",
    .reproduces = "affine maps",
    .on_cage = "interpolates",
    .outside = "refused, or at rest",
    .locality = "what is seen; continuous, not smooth",
    .made_by = "visibility, then closed form",
    .cost = "2000 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = vertex_rule,
};

} // namespace cagewright
