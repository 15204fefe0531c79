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
#include <cstdint>
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
};

/// Those of many faces, number by number: most faces meet few.
class Caps {
public:
  void add(const Cap& cap) {
    x_.push_back(cap.axis.x());
    y_.push_back(cap.axis.y());
    z_.push_back(cap.axis.z());
    cosine_.push_back(cap.cosine);
    sine_.push_back(cap.sine);
  }

  /// Writes 1 for those that meet a cap, and 0 for others.
  void find_meeting(const Cap& cap, std::vector<std::uint8_t>& meeting) const {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      // The angle of the axes against the sum of the two angles.
      const double both = cap.cosine * cosine_[i] - cap.sine * sine_[i];
      const double wide = cap.sine * cosine_[i] + cap.cosine * sine_[i]; // their sum exceeds pi
      const double between = cap.axis.x() * x_[i] + cap.axis.y() * y_[i] + cap.axis.z() * z_[i];
      meeting[i] = static_cast<std::uint8_t>(static_cast<unsigned>(wide <= 0) |
                                             static_cast<unsigned>(between >= both - 1e-12));
    }
  }

private:
  std::vector<double> x_, y_, z_, cosine_, sine_;
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

/// How far the corners of a polygon are on the positive side of a plane through the origin.
struct SidesOfPlane {
  std::array<double, Polygon::most_corners> at;
  bool some_inside = false;
  bool some_outside = false;

  SidesOfPlane(const Polygon& polygon, const Vec3& plane) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      at[i] = plane.dot(polygon[i]);
      some_inside = some_inside || at[i] > 0;
      some_outside = some_outside || at[i] < 0;
    }
  }
};

/// Writes the parts of a convex polygon on either side of the plane.
void split(const Polygon& polygon, const SidesOfPlane& sides, Polygon& inside, Polygon& outside) {
  const auto& at = sides.at;
  inside.clear();
  outside.clear();
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

  /// Whether some of its shadow's planes has all of these points on its outer side.
  template <class Points> [[nodiscard]] bool is_apart_from(const Points& points) const {
    return std::any_of(planes.begin(), planes.end(), [&](const Vec3& plane) {
      return std::all_of(points.begin(), points.end(),
                         [&](const Vec3& p) { return plane.dot(p) <= 0; });
    });
  }

  /// Whether the points lie in its shadow, behind it.
  template <class Points> [[nodiscard]] bool hides(const Points& points) const {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
      return planes[0].dot(p) >= 0 && planes[1].dot(p) >= 0 && planes[2].dot(p) >= 0 &&
             normal.dot(p) < offset;
    });
  }
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
    // Those that hide most first: what is hidden is then not cut to pieces before.
    std::stable_sort(blockers_.begin(), blockers_.end(), [](const Blocker& a, const Blocker& b) {
      return a.cap.cosine < b.cap.cosine;
    });
    for (const Blocker& blocker : blockers_) {
      caps_.add(blocker.cap);
    }
    meeting_.resize(blockers_.size());
  }

  /// Adds the weights of the corners of a face that is seen from inside.
  void add(std::size_t f, std::vector<double>& weights) {
    const Surface::Face& face = surface_.faces[f];
    if (!find_blockers_of(f)) {
      return;
    }
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
        if (blocker->is_apart_from(piece)) {
          left_.push_back(piece);
        } else if (!blocker->hides(piece)) {
          cut(piece, *blocker, left_);
        }
      }
      std::swap(pieces_, left_);
      if (pieces_.empty()) {
        return;
      }
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

  /// Those that hide some of a face, those that hide most of the view first.
  /// \returns whether none hides all of it
  bool find_blockers_of(std::size_t f) {
    found_.clear();
    if (blockers_.empty()) {
      return true;
    }
    const std::array<Vec3, 3> corners = corners_of(f);
    const Cap cap = cap_of(directions_to(f));
    std::array<Vec3, 3> planes;
    for (std::size_t e = 0; e < 3; ++e) {
      planes[e] = corners[e].cross(corners[(e + 1) % 3]);
    }
    const Vec3& normal = surface_.faces[f].normal;
    const double height = point_.face(f).height;
    caps_.find_meeting(cap, meeting_);
    for (std::size_t b = 0; b < blockers_.size(); ++b) {
      if (meeting_[b] == 0) {
        continue;
      }
      const Blocker& blocker = blockers_[b];
      const bool is_behind = std::all_of(blocker.corners.begin(), blocker.corners.end(),
                                         [&](const Vec3& p) { return normal.dot(p) >= height; });
      if (is_behind || blocker.is_apart_from(corners) ||
          std::any_of(planes.begin(), planes.end(), [&](const Vec3& plane) {
            return plane.dot(blocker.corners[0]) <= 0 && plane.dot(blocker.corners[1]) <= 0 &&
                   plane.dot(blocker.corners[2]) <= 0;
          })) {
        continue;
      }
      if (blocker.hides(corners)) {
        return false;
      }
      found_.push_back(&blocker);
    }
    return true;
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
    if (std::all_of(piece.begin(), piece.end(),
                    [&](const Vec3& p) { return blocker.normal.dot(p) >= blocker.offset; })) {
      left.push_back(piece); // nearer than the blocker
      return;
    }
    const std::size_t before = left.size();
    std::array<Polygon, 2> room;
    const Polygon* shadow = &piece;
    for (const Vec3& plane : blocker.planes) {
      const SidesOfPlane sides(*shadow, plane);
      if (!sides.some_outside) {
        continue;
      }
      if (!sides.some_inside) {
        shadow = nullptr;
        break;
      }
      Polygon& inside = shadow == room.data() ? room[1] : room[0];
      Polygon& outside = left.emplace_back();
      split(*shadow, sides, inside, outside);
      if (outside.size() < 3 || twice_area(outside) <= no_area) {
        left.pop_back();
      }
      shadow = &inside;
    }
    bool hides = shadow != nullptr && shadow->size() >= 3 && twice_area(*shadow) > no_area;
    if (hides) {
      Vec3 middle = Vec3::Zero();
      for (const Vec3& p : *shadow) {
        middle += p / static_cast<double>(shadow->size());
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
  Caps caps_; // of the blockers
  // Room for a face.
  std::vector<std::uint8_t> meeting_;
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
    .cost = "900 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_inside<positive_mean_value_coordinates, PositiveMeanValueOptions>,
    .rule = vertex_rule,
};

} // namespace cagewright
