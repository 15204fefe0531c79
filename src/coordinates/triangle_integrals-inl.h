// What integrals over the triangles of a cage are made of, for points off and near the cage:
// heights, solid angles, and integrals of 1 / r along the edges. Included once for each instruction
// set by
// *_simd.cpp. Internal to this module.
//
// LanePoints does it for several points side by side, and leaves out of account those that it
// cannot do well: they are told by flagged(), and done one by one by PointTerms, where nothing
// cancels.
//
// Near an edge, at distance D, the solid angles of the two faces beside it hang on the direction in
// which the point lies, and err by 1e-16 / D; but their sum does not. So it matters that both are
// computed from one and the same offset p of the point from the edge, wrong as it may be: then they
// err alike. Near a vertex the differences to its position are exact, and so is all that follows.

#if defined(CAGEWRIGHT_COORDINATES_TRIANGLE_INTEGRALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAGEWRIGHT_COORDINATES_TRIANGLE_INTEGRALS_INL_H_
#undef CAGEWRIGHT_COORDINATES_TRIANGLE_INTEGRALS_INL_H_
#else
#define CAGEWRIGHT_COORDINATES_TRIANGLE_INTEGRALS_INL_H_
#endif

#include "coordinates/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {

constexpr double full_angle = 12.566370614359172954; // 4 pi

/// Nearer than this to an edge or a vertex points are done one by one; in the units of the frame.
constexpr double near_edge = 1e-3;
/// Nearer than this, in diagonals, a point lies on the cage.
constexpr double on_cage = 1e-13;

/// A face as seen from a point: a_e the corners from there, d_e = |a_e|.
template <class V> struct FaceTerms {
  V height;      ///< h, positive inside
  V omega;       ///< the signed solid angle
  V rho[3];      ///< nu_e . a_e
  V log[3];      ///< L_e, the integral of 1 / r along edge e; 0 on it
  V lambda[3];   ///< barycentric coordinates of the projection
  V distance[3]; ///< d_e

  /// g_i . q, with q = sum of L_e nu_e.
  HWY_INLINE V slope(const Surface::Face& face, std::size_t i) const {
    return fma(V(face.slope[i][0]), log[0],
               fma(V(face.slope[i][1]), log[1], V(face.slope[i][2]) * log[2]));
  }
  /// The integral of 1 / r over the face.
  HWY_INLINE V potential() const {
    return fma(rho[0], log[0], fma(rho[1], log[1], fma(rho[2], log[2], -(height * omega))));
  }
};

HWY_INLINE Lanes affine_at(const std::array<double, 4>& f, Lanes x, Lanes y, Lanes z) {
  return fma(Lanes(f[0]), x, fma(Lanes(f[1]), y, fma(Lanes(f[2]), z, Lanes(f[3]))));
}

class LanePoints {
public:
  /// \param scratch  scratch_size() numbers, aligned
  /// \param near     nearer than this to an edge or a vertex points are flagged
  LanePoints(const Surface& surface, const double* x, const double* y, const double* z,
             double* scratch, double near = near_edge)
      : surface_(surface), x_(Lanes::load(x)), y_(Lanes::load(y)), z_(Lanes::load(z)),
        distance_(scratch), log_(scratch + surface.positions.size() * lanes) {
    Lanes nearest(1e300);
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      const Vec3& p = surface.positions[i];
      const Lanes dx = Lanes(p.x()) - x_;
      const Lanes dy = Lanes(p.y()) - y_;
      const Lanes dz = Lanes(p.z()) - z_;
      const Lanes d = root(fma(dx, dx, fma(dy, dy, dz * dz)));
      nearest = smaller(nearest, d);
      d.store(distance_ + i * lanes);
    }
    flagged_ = nearest < Lanes(near);
    for (std::size_t i = 0; i < surface.edges.size(); ++i) {
      const Surface::Edge& edge = surface.edges[i];
      const Lanes length(edge.length);
      const Lanes sum =
          Lanes::load(distance_ + edge.from * lanes) + Lanes::load(distance_ + edge.to * lanes);
      const Lanes more = sum + length;
      const Lanes gap = sum - length; // at least 2 D^2 / length
      flagged_ = flagged_ | (gap < Lanes(2 * near * near / edge.length));
      logarithm(more / larger(gap, Lanes(1e-30))).store(log_ + i * lanes);
    }
    near_edges_ = flagged_;
  }

  static std::size_t scratch_size(const Surface& surface) {
    return (surface.positions.size() + surface.edges.size()) * lanes;
  }

  HWY_INLINE FaceTerms<Lanes> face(std::size_t index) {
    const Surface::Face& face = surface_.faces[index];
    FaceTerms<Lanes> f;
    f.height = affine_at(face.height, x_, y_, z_);
    flagged_ = flagged_ | (absolute(f.height) < Lanes(2 * on_cage));
    Lanes square[3];
    for (std::size_t e = 0; e < 3; ++e) {
      f.rho[e] = affine_at(face.rho[e], x_, y_, z_);
      f.log[e] = Lanes::load(log_ + face.edges[e] * lanes);
      f.distance[e] = Lanes::load(distance_ + face.vertices[e] * lanes);
      square[e] = f.distance[e] * f.distance[e];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      f.lambda[i] = f.rho[(i + 1) % 3] * Lanes(face.share[i]);
    }
    // Twice the scalar product of two corners is the sum of the squares less that of the edge.
    Lanes twice = (f.distance[0] + f.distance[0]) * f.distance[1] * f.distance[2];
    for (std::size_t e = 0; e < 3; ++e) {
      const std::size_t next = (e + 1) % 3;
      const Lanes dot = square[e] + square[next] - Lanes(face.length[e] * face.length[e]);
      twice = fma(dot, f.distance[(e + 2) % 3], twice);
    }
    const Lanes half = angle_of(Lanes(2 * face.twice_area) * f.height, twice);
    f.omega = half + half;
    winding_ += f.omega;
    return f;
  }

  [[nodiscard]] HWY_INLINE Lanes distance(std::size_t vertex) const {
    return Lanes::load(distance_ + vertex * lanes);
  }

  /// L_e.
  [[nodiscard]] HWY_INLINE Lanes log(std::size_t edge) const {
    return Lanes::load(log_ + edge * lanes);
  }

  /// Points near an edge or a vertex.
  [[nodiscard]] LaneFlags near_edges() const { return LaneFlags(near_edges_); }

  /// Points near an edge, a vertex or a face seen so far.
  [[nodiscard]] LaneFlags near() const { return LaneFlags(flagged_); }

  /// Points that PointTerms must do, after all faces were seen: near the cage or not inside it
  /// once.
  [[nodiscard]] LaneFlags flagged() const {
    const Lanes off = absolute(winding_ - Lanes(full_angle));
    // Not: off > ..., which is false for what is no number.
    return LaneFlags({hn::Or(hn::Not((off < Lanes(1e-3)).m), flagged_.m)});
  }

private:
  const Surface& surface_;
  Lanes x_, y_, z_;
  double* distance_;
  double* log_;
  Lanes winding_ = Lanes(0.0);
  Mask near_edges_;
  Mask flagged_;
};

/// One point, with care.
class PointTerms {
public:
  PointTerms(const Surface& surface, const Vec3& x) : surface_(surface), x_(x) {
    for (const Vec3& p : surface.positions) {
      to_vertex_.emplace_back(p - x);
      distance_.push_back(to_vertex_.back().norm());
    }
    for (const Surface::Edge& edge : surface.edges) {
      edges_.push_back(edge_terms(edge));
    }
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      faces_.push_back(face_terms(surface.faces[f]));
      face_distance_.push_back(distance_to(surface.faces[f], faces_.back()));
    }
  }

  struct EdgeTerms {
    Vec3 offset;         ///< p: from the point to the line, at right angles
    double square = 0;   ///< D^2
    double tau = 0;      ///< t . a of the end `from`
    double tau_next = 0; ///< of the other: tau + length, but exact where it is small
    double half_e = 0;   ///< d d' + a . a', without cancellation
    double log = 0;

    /// Whether the point is beside the edge, not beyond its ends.
    [[nodiscard]] bool is_between() const { return tau < 0 && tau_next > 0; }
  };

  [[nodiscard]] const FaceTerms<double>& face(std::size_t f) const { return faces_[f]; }
  [[nodiscard]] const EdgeTerms& edge(std::size_t e) const { return edges_[e]; }
  [[nodiscard]] const Vec3& to_vertex(std::size_t v) const { return to_vertex_[v]; }
  [[nodiscard]] double distance(std::size_t v) const { return distance_[v]; }
  /// From the point to the triangle.
  [[nodiscard]] double face_distance(std::size_t f) const { return face_distance_[f]; }

  [[nodiscard]] bool is_finite() const { return x_.allFinite(); }
  [[nodiscard]] bool touches(std::size_t f) const {
    return face_distance_[f] < on_cage * surface_.frame.scaled_diagonal();
  }

private:
  [[nodiscard]] EdgeTerms edge_terms(const Surface::Edge& edge) const {
    EdgeTerms terms;
    const bool from_is_near = distance_[edge.from] <= distance_[edge.to];
    const Vec3& near = to_vertex_[from_is_near ? edge.from : edge.to];
    const double along = near.dot(edge.along);
    terms.offset = near - along * edge.along;
    terms.offset -= terms.offset.dot(edge.along) * edge.along;
    terms.square = terms.offset.squaredNorm();
    terms.tau = from_is_near ? along : along - edge.length;
    terms.tau_next = from_is_near ? along + edge.length : along;
    const double product = distance_[edge.from] * distance_[edge.to];
    const double dot = terms.tau * terms.tau_next + terms.square;
    terms.half_e =
        dot < 0 ? edge.length * edge.length * terms.square / (product - dot) : product + dot;
    constexpr double on_edge = 1e-14;
    if (!(terms.is_between() && terms.square < on_edge * on_edge) && terms.half_e > 0) {
      const double more = distance_[edge.from] + distance_[edge.to] + edge.length;
      terms.log = logarithm(more * more / (2 * terms.half_e));
    }
    return terms;
  }

  /// From the point to edge e of a face.
  [[nodiscard]] double segment_distance(const Surface::Face& face, std::size_t e) const {
    const EdgeTerms& terms = edges_[face.edges[e]];
    return terms.is_between()
               ? std::sqrt(terms.square)
               : std::min(distance_[face.vertices[e]], distance_[face.vertices[(e + 1) % 3]]);
  }

  [[nodiscard]] FaceTerms<double> face_terms(const Surface::Face& face) const {
    FaceTerms<double> f;
    std::size_t nearest = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      const EdgeTerms& terms = edges_[face.edges[e]];
      f.rho[e] = face.outward[e].dot(terms.offset);
      f.log[e] = terms.log;
      f.distance[e] = distance_[face.vertices[e]];
      nearest = segment_distance(face, e) < segment_distance(face, nearest) ? e : nearest;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      f.lambda[i] = f.rho[(i + 1) % 3] * face.share[i];
    }
    const EdgeTerms& edge = edges_[face.edges[nearest]];
    f.height = face.normal.dot(edge.offset);
    f.omega = 2 * angle_of(face.twice_area * f.height, denominator(face, nearest));
    return f;
  }

  /// d0 d1 d2 + (a0.a1) d2 + (a1.a2) d0 + (a2.a0) d1, with care near edge e.
  [[nodiscard]] double denominator(const Surface::Face& face, std::size_t e) const {
    const EdgeTerms& terms = edges_[face.edges[e]];
    const Surface::Edge& edge = surface_.edges[face.edges[e]];
    const double d0 = distance_[edge.from];
    const double d1 = distance_[edge.to];
    const double tau = terms.tau;
    const double tau_next = terms.tau_next;
    const double across = terms.is_between() ? terms.square * edge.length * (tau_next + tau) /
                                                   (tau_next * d0 - tau * d1)
                                             : tau_next * d0 + tau * d1;
    const Index opposite = face.vertices[(e + 2) % 3];
    return distance_[opposite] * terms.half_e +
           to_vertex_[opposite].dot(across * edge.along + (d0 + d1) * terms.offset);
  }

  [[nodiscard]] double distance_to(const Surface::Face& face, const FaceTerms<double>& f) const {
    if (f.rho[0] >= 0 && f.rho[1] >= 0 && f.rho[2] >= 0) {
      return std::abs(f.height);
    }
    return std::min(
        {segment_distance(face, 0), segment_distance(face, 1), segment_distance(face, 2)});
  }

  const Surface& surface_;
  Vec3 x_;
  std::vector<Vec3> to_vertex_;
  std::vector<double> distance_;
  std::vector<EdgeTerms> edges_;
  std::vector<FaceTerms<double>> faces_;
  std::vector<double> face_distance_;
};

/// J_e, the integrals of r along all edges, for each lane.
HWY_INLINE void length_integrals(const Surface& surface, const LanePoints& points, Lanes x, Lanes y,
                                 Lanes z, double* to) {
  for (std::size_t i = 0; i < surface.edges.size(); ++i) {
    const Surface::Edge& edge = surface.edges[i];
    const Vec3& from = surface.positions[edge.from];
    const Lanes tau = fma(Lanes(from.x()) - x, Lanes(edge.along.x()),
                          fma(Lanes(from.y()) - y, Lanes(edge.along.y()),
                              (Lanes(from.z()) - z) * Lanes(edge.along.z())));
    const Lanes d = points.distance(edge.from);
    const Lanes d_next = points.distance(edge.to);
    const Lanes square = larger(d * d - tau * tau, Lanes(0.0));
    const Lanes twice = fma(tau + Lanes(edge.length), d_next, -(tau * d)) + square * points.log(i);
    (twice * Lanes(0.5)).store(to + i * lanes);
  }
}

/// The same of an edge for one point, with care.
inline double length_integral(const Surface::Edge& edge, const PointTerms& point,
                              const PointTerms::EdgeTerms& terms) {
  return (terms.tau_next * point.distance(edge.to) - terms.tau * point.distance(edge.from) +
          terms.square * terms.log) /
         2;
}

/// Sixteen points, some of them perhaps the last one again.
struct SixteenPoints {
  alignas(64) std::array<double, 16> x, y, z;

  explicit SixteenPoints(std::span<const Vec3> points) {
    for (std::size_t i = 0; i < 16; ++i) {
      const Vec3& p = points[std::min(i, points.size() - 1)];
      x[i] = p.x();
      y[i] = p.y();
      z[i] = p.z();
    }
  }
};

/// Whether arithmetic with a point leads anywhere.
inline bool is_usable(const Vec3& x) {
  return x.allFinite() && x.cwiseAbs().maxCoeff() < 1e100;
}

/// The first of vertices with middles, one for each lane, to the weights of the cage's vertices.
HWY_INLINE void put_vertices(const Surface& surface, double* phi, double* out, std::size_t stride) {
  for (std::size_t q = 0; q < surface.quads.size(); ++q) {
    const Lanes share = Lanes::load(phi + (surface.cage_vertices + q) * lanes) * Lanes(0.25);
    for (const Index corner : surface.quads[q]) {
      (Lanes::load(phi + corner * lanes) + share).store(phi + corner * lanes);
    }
  }
  for (std::size_t c = 0; c < surface.cage_vertices; ++c) {
    Lanes::load(phi + c * lanes).store_unaligned(out + c * stride);
  }
}

/// The same for point i alone; `phi` has stride 1.
inline void put_vertices_of(const Surface& surface, std::span<double> phi, double* weights,
                            std::size_t stride, std::size_t i) {
  surface.share_middles(phi);
  for (std::size_t c = 0; c < surface.cage_vertices; ++c) {
    weights[c * stride + i] = phi[c];
  }
}

/// What the faces of a cage mean for a point that is not plainly inside.
struct PointPlace {
  bool on_surface = false;
  bool outside = false;
  /// How often the cage goes round the point; 1 inside.
  int winding = 1;
  /// On the cage: the hats there, of vertices and middles. They stand for the solid angles of the
  /// faces touched.
  std::array<std::pair<Index, double>, 3> hats;
  /// Outside: faces through which the formulas are continued, and their shares.
  std::vector<std::pair<std::size_t, double>> through;
};

/// The hats of a face that the point lies on.
inline std::array<double, 3> hats_on(const PointTerms& point, std::size_t f) {
  std::array<double, 3> hats;
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    hats[i] = std::clamp(point.face(f).lambda[i], 0.0, 1.0);
    sum += hats[i];
  }
  for (double& hat : hats) {
    hat /= sum;
  }
  return hats;
}

/// \param touching  nearer than this, in diagonals, a point lies on the cage
inline PointPlace place_of(const Surface& surface, const PointTerms& point,
                           double touching = on_cage) {
  PointPlace place;
  std::size_t nearest = 0;
  double angle = 0;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    nearest = point.face_distance(f) < point.face_distance(nearest) ? f : nearest;
    angle += point.face(f).omega;
  }
  if (point.face_distance(nearest) < touching * surface.frame.scaled_diagonal()) {
    place.on_surface = true;
    const std::array<double, 3> hats = hats_on(point, nearest);
    for (std::size_t i = 0; i < 3; ++i) {
      place.hats[i] = {surface.faces[nearest].vertices[i], hats[i]};
    }
    return place;
  }
  place.winding = static_cast<int>(std::lround(angle / full_angle));
  place.outside = place.winding <= 0;
  if (place.outside) {
    const double reach = 1.5 * point.face_distance(nearest);
    double sum = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const double inside = reach - point.face_distance(f);
      if (inside > 0) {
        place.through.emplace_back(f, inside * inside);
        sum += inside * inside;
      }
    }
    for (auto& [face, share] : place.through) {
      share /= sum;
    }
  }
  return place;
}

/// The weights of vertices and middles for point i of a tile that is computed with care: on the
/// cage its hats, outside none. \param inside  (const PointTerms& point, std::vector<double>&
/// weights): fills in the weights, all
///                0 before, of a point that is inside; returns false where there are none
template <class Inside>
std::vector<double> weights_with_care(const Surface& surface, const Vec3& x, std::size_t i,
                                      double touching, TileReport& report, const Inside& inside) {
  std::vector<double> weights(surface.positions.size(), 0.0);
  const auto bit = static_cast<std::uint16_t>(1U << i);
  if (!is_usable(x)) {
    report.undefined |= bit;
    return weights;
  }
  const PointTerms point(surface, x);
  const PointPlace place = place_of(surface, point, touching);
  if (place.on_surface) {
    report.on_surface |= bit;
    for (const auto& [vertex, hat] : place.hats) {
      weights[vertex] += hat;
    }
  } else if (place.outside) {
    report.outside |= bit;
  } else if (!inside(point, weights)) {
    report.undefined |= bit;
    std::fill(weights.begin(), weights.end(), 0.0);
  }
  return weights;
}

} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#endif
