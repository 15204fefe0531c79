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

/// Corners of a convex polygon, as seen from the point: it is the origin. Most have three to six,
/// and there are millions of them: they are kept without a memory of their own.
class Polygon {
public:
  static constexpr std::size_t most_corners = 16;
  /// Of one that is cut by three planes: each adds a corner, or two where rounding has bent it.
  static constexpr std::size_t most_to_cut = most_corners - 6;

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const Vec3& operator[](std::size_t i) const { return corners_[i]; }
  [[nodiscard]] const Vec3* begin() const { return corners_.data(); }
  [[nodiscard]] const Vec3* end() const { return corners_.data() + count_; }
  void push_back(const Vec3& p) { corners_[count_++] = p; }
  void clear() { count_ = 0; }

  Polygon() = default;
  Polygon(const Polygon& other) { *this = other; }
  Polygon& operator=(const Polygon& other) {
    std::copy(other.begin(), other.end(), corners_.begin());
    count_ = other.count_;
    return *this;
  }

private:
  std::array<Vec3, most_corners> corners_;
  std::size_t count_ = 0;
};

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

/// \param directions  to the corners
Cap cap_of(const std::array<Vec3, 3>& directions) {
  const Vec3 middle = directions[0] + directions[1] + directions[2];
  if (middle.norm() < 1e-6) { // all round the point
    return {Vec3::UnitX(), -1, 0};
  }
  Cap cap{middle.normalized(), 1, 0};
  for (const Vec3& direction : directions) {
    cap.cosine = std::min(cap.cosine, cap.axis.dot(direction));
  }
  if (cap.cosine <= 0) { // the widest place need no longer be a corner
    cap.cosine = -1;
  }
  cap.sine = std::sqrt(std::max(0.0, 1 - cap.cosine * cap.cosine));
  return cap;
}

/// Writes the parts of a convex polygon on either side of a plane through the origin.
void split(const Polygon& polygon, const Vec3& plane, Polygon& inside, Polygon& outside) {
  inside.clear();
  outside.clear();
  std::array<double, Polygon::most_corners> at;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    at[i] = plane.dot(polygon[i]);
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = i + 1 < polygon.size() ? i + 1 : 0;
    (at[i] >= 0 ? inside : outside).push_back(polygon[i]);
    if ((at[i] >= 0) != (at[next] >= 0)) {
      const Vec3 between = polygon[i] + at[i] / (at[i] - at[next]) * (polygon[next] - polygon[i]);
      inside.push_back(between);
      outside.push_back(between);
    }
  }
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
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
      directions_.emplace_back(point.to_vertex(v) / point.distance(v));
    }
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      if (point.face(f).height < 0) {
        add_blocker(f);
      }
    }
  }

  /// Adds the weights of the corners of a face that is seen from inside.
  void add(std::size_t f, std::vector<double>& weights) {
    const Surface::Face& face = surface_.faces[f];
    find_blockers_of(f);
    if (found_.empty()) {
      double whole[3];
      scalar::view_weights_of(surface_, point_, f, whole);
      for (std::size_t k = 0; k < 3; ++k) {
        weights[face.vertices[k]] += whole[k];
      }
      return;
    }
    pieces_.clear();
    Polygon& all = pieces_.emplace_back();
    for (const Vec3& corner : corners_of(f)) {
      all.push_back(corner);
    }
    for (const Blocker* blocker : found_) {
      left_.clear();
      for (const Polygon& piece : pieces_) {
        cut(piece, *blocker, left_);
      }
      std::swap(pieces_, left_);
    }
    for (const Polygon& piece : pieces_) {
      add_piece(f, piece, weights);
    }
  }

private:
  [[nodiscard]] std::array<Vec3, 3> corners_of(std::size_t f) const {
    const std::array<Index, 3>& v = surface_.faces[f].vertices;
    return {point_.to_vertex(v[0]), point_.to_vertex(v[1]), point_.to_vertex(v[2])};
  }

  [[nodiscard]] std::array<Vec3, 3> directions_to(std::size_t f) const {
    const std::array<Index, 3>& v = surface_.faces[f].vertices;
    return {directions_[v[0]], directions_[v[1]], directions_[v[2]]};
  }

  void add_blocker(std::size_t f) {
    Blocker blocker;
    blocker.corners = corners_of(f);
    for (std::size_t e = 0; e < 3; ++e) { // its corners run clockwise as they are seen
      blocker.planes[e] = blocker.corners[(e + 1) % 3].cross(blocker.corners[e]);
    }
    blocker.normal = surface_.faces[f].normal;
    blocker.offset = point_.face(f).height;
    blocker.cap = cap_of(directions_to(f));
    blockers_.push_back(blocker);
  }

  void find_blockers_of(std::size_t f) {
    found_.clear();
    if (blockers_.empty()) {
      return;
    }
    const std::array<Vec3, 3> corners = corners_of(f);
    const Cap cap = cap_of(directions_to(f));
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
      const bool is_behind = std::all_of(blocker.corners.begin(), blocker.corners.end(),
                                         [&](const Vec3& p) { return normal.dot(p) >= height; });
      const bool is_apart =
          std::any_of(blocker.planes.begin(), blocker.planes.end(),
                      [&](const Vec3& plane) { return all_outside(plane, corners); }) ||
          std::any_of(planes.begin(), planes.end(),
                      [&](const Vec3& plane) { return all_outside(plane, blocker.corners); });
      if (!is_behind && !is_apart) {
        found_.push_back(&blocker);
      }
    }
  }

  /// Appends what the blocker leaves of a piece.
  static void cut(const Polygon& piece, const Blocker& blocker, std::vector<Polygon>& left) {
    constexpr double no_area = 1e-28;
    if (piece.size() > Polygon::most_to_cut) { // by halves
      for (const std::size_t first : {std::size_t(1), piece.size() / 2}) {
        Polygon half;
        half.push_back(piece[0]);
        const std::size_t last = first == 1 ? piece.size() / 2 : piece.size() - 1;
        for (std::size_t i = first; i <= last; ++i) {
          half.push_back(piece[i]);
        }
        cut(half, blocker, left);
      }
      return;
    }
    const std::size_t before = left.size();
    Polygon shadow = piece;
    Polygon inside;
    Polygon outside;
    for (const Vec3& plane : blocker.planes) {
      split(shadow, plane, inside, outside);
      shadow = inside;
      if (outside.size() >= 3 && twice_area(outside) > no_area) {
        left.push_back(outside);
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
      left.resize(before);
      left.push_back(piece);
    }
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
  std::vector<Vec3> directions_; // to the vertices
  std::vector<Blocker> blockers_;
  // Room for a face.
  std::vector<const Blocker*> found_;
  std::vector<Polygon> pieces_, left_;
};

/// \returns whether they then reproduce the point: they do but where the cage crosses itself
bool normalize(const scalar::PointTerms& point, std::vector<double>& weights) {
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
    off += weights[v] * point.to_vertex(v);
  }
  return off.norm() < reproduced; // not where there is nothing to be seen: that is no number
}

bool solve_inside(const Surface& surface, const scalar::PointTerms& point,
                  std::vector<double>& weights) {
  Views views(surface, point);
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    if (point.face(f).height > 0) {
      views.add(f, weights);
    }
  }
  return normalize(point, weights);
}

TileReport positive_tile(const UsedSurface& cage, std::span<const Vec3> points,
                         const WeightsOfTile& out) {
  TileReport report;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<double> weights =
        scalar::weights_with_care(cage.surface, points[i], i, scalar::on_cage, report,
                                  [&](const scalar::PointTerms& point, std::vector<double>& own) {
                                    return solve_inside(cage.surface, point, own);
                                  });
    scalar::put_vertices_of(cage.surface, weights, out.weights, out.stride, i);
  }
  return report;
}

constexpr std::array<const CoordinateOption*, 2> kind_options = {&quads_option, &outside_option};

} // namespace

Result<std::shared_ptr<const Coordinates>>
positive_mean_value_coordinates(const PolygonMesh& cage, const PositiveMeanValueOptions& options) {
  return inside_coordinates(cage, options.quads, options.outside, positive_tile);
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
    .cost = "1300 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_inside<positive_mean_value_coordinates, PositiveMeanValueOptions>,
    .rule = vertex_rule,
};

} // namespace cagewright
