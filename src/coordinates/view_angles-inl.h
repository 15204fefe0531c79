// Mean value weights of single triangles, for one point or several side by side: what a point sees
// of them. Included once for each instruction set by *_simd.cpp. Internal to this module.
//
// With A_e = (the angle under which edge e is seen) / (the distance D_e of its line), the integral
// over the face of hat function i, divided by the distance, over what is seen is
//     w_i = lambda_i sigma / 2 h - (h / 2) sum over the edges of (g_i . nu_e) A_e,
//     sigma = sum of rho_e A_e.
// sigma vanishes with h^2 in the plane of the face, beside it. There each angle is compared with
// that of the point's projection, of which the signed sum is 0 (beside the face) or 2 pi (on it)
// exactly, and the difference of two arctangents is one that does not cancel.

#if defined(CAGEWRIGHT_COORDINATES_VIEW_ANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAGEWRIGHT_COORDINATES_VIEW_ANGLES_INL_H_
#undef CAGEWRIGHT_COORDINATES_VIEW_ANGLES_INL_H_
#else
#define CAGEWRIGHT_COORDINATES_VIEW_ANGLES_INL_H_
#endif

#include "coordinates/triangle_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {

/// Nearer than this to the plane of a face the careful sum is taken.
constexpr double near_plane = 2e-3;

/// An edge as seen from a point.
template <class V> struct EdgeView {
  V angle;    ///< under which it is seen
  V distance; ///< D, of its line
  V tau;      ///< along it, from the point's projection to the ends
  V tau_next;
};

/// What a triangle with these edges adds to sigma, computed from the projection of the point.
template <class V> HWY_INLINE V careful_part(const EdgeView<V>& edge, V rho, V height) {
  const V size = absolute(rho);
  const V square = height * height;
  const V d = larger(edge.distance, V(1e-150));
  const V less = square / (d + size); // D - |rho|
  const V product = d * size;
  // atan(tau' / D) - atan(tau' / |rho|), and the same at the other end.
  const V there = angle_of(edge.tau_next * less, fma(edge.tau_next, edge.tau_next, product));
  const V here = angle_of(edge.tau * less, fma(edge.tau, edge.tau, product));
  const V part = here - there - edge.angle * (less / d);
  return select(rho < V(0.0), -part, part);
}

/// The three weights of a face, all of the sign of the height.
/// \param slope  g_i . nu_e at [i][e]
template <class V>
HWY_INLINE void view_weights(const std::array<std::array<double, 3>, 3>& slope, const V (&rho)[3],
                             const V (&lambda)[3], V height, const EdgeView<V> (&edges)[3],
                             V (&weights)[3]) {
  V per_distance[3];
  V sigma(0.0);
  for (std::size_t e = 0; e < 3; ++e) {
    per_distance[e] = edges[e].angle / larger(edges[e].distance, V(1e-150));
    sigma = fma(rho[e], per_distance[e], sigma);
  }
  const auto near = absolute(height) < V(near_plane);
  if (HWY_UNLIKELY(!none_of(near))) {
    const V least = smaller(rho[0], smaller(rho[1], rho[2]));
    V careful = select(least < V(0.0), V(0.0), V(full_angle / 2));
    for (std::size_t e = 0; e < 3; ++e) {
      careful += careful_part(edges[e], rho[e], height);
    }
    sigma = select(near, careful, sigma);
  }
  const V sign = select(height < V(0.0), V(-1.0), V(1.0));
  const V half = V(0.5) * height;
  const V potential = sigma * V(0.5) / (sign * larger(absolute(height), V(1e-150)));
  for (std::size_t i = 0; i < 3; ++i) {
    const V across = fma(V(slope[i][0]), per_distance[0],
                         fma(V(slope[i][1]), per_distance[1], V(slope[i][2]) * per_distance[2]));
    weights[i] = fma(lambda[i], potential, -(half * across));
  }
}

/// Several points. Those near edges, vertices and faces, and those that are not inside, are
/// flagged.
class LaneViews {
public:
  LaneViews(const Surface& surface, const double* x, const double* y, const double* z,
            double* scratch)
      : surface_(surface), x_(Lanes::load(x)), y_(Lanes::load(y)), z_(Lanes::load(z)),
        distance_(scratch), edge_(scratch + surface.positions.size() * lanes) {
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
    flagged_ = nearest < Lanes(near_edge);
    for (std::size_t i = 0; i < surface.edges.size(); ++i) {
      measure(surface.edges[i], edge_ + 3 * i * lanes);
    }
  }

  static std::size_t scratch_size(const Surface& surface) {
    return (surface.positions.size() + 3 * surface.edges.size()) * lanes;
  }

  [[nodiscard]] HWY_INLINE Lanes distance(std::size_t vertex) const {
    return Lanes::load(distance_ + vertex * lanes);
  }

  /// \returns the height
  HWY_INLINE Lanes weights(std::size_t index, Lanes (&weights)[3]) {
    const Surface::Face& face = surface_.faces[index];
    Lanes rho[3];
    Lanes lambda[3];
    EdgeView<Lanes> edges[3];
    const Lanes height = affine_at(face.height, x_, y_, z_);
    flagged_ = flagged_ | (absolute(height) < Lanes(2 * on_cage));
    for (std::size_t e = 0; e < 3; ++e) {
      rho[e] = affine_at(face.rho[e], x_, y_, z_);
      const double* const from = edge_ + 3 * face.edges[e] * lanes;
      const Lanes tau = Lanes::load(from + 2 * lanes);
      edges[e] = {Lanes::load(from), Lanes::load(from + lanes), tau,
                  tau + Lanes(surface_.edges[face.edges[e]].length)};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      lambda[i] = rho[(i + 1) % 3] * Lanes(face.share[i]);
    }
    view_weights(face.slope, rho, lambda, height, edges, weights);
    sum_ += weights[0] + weights[1] + weights[2];
    return height;
  }

  /// Those near edges and vertices, and faces seen so far.
  [[nodiscard]] LaneFlags near() const { return LaneFlags(flagged_); }

  /// After all faces were seen. Inside, what is seen first along each ray is seen from inside: the
  /// sum of all weights is positive; outside it is negative.
  [[nodiscard]] LaneFlags flagged() const {
    // At least 4 pi over the diameter inside.
    return LaneFlags({hn::Or(hn::Not((sum_ > Lanes(1.0)).m), flagged_.m)});
  }

private:
  HWY_INLINE void measure(const Surface::Edge& edge, double* to) {
    const Vec3& from = surface_.positions[edge.from];
    const Lanes ax = Lanes(from.x()) - x_;
    const Lanes ay = Lanes(from.y()) - y_;
    const Lanes az = Lanes(from.z()) - z_;
    const Lanes tau =
        fma(ax, Lanes(edge.along.x()), fma(ay, Lanes(edge.along.y()), az * Lanes(edge.along.z())));
    const Lanes px = ax - tau * Lanes(edge.along.x());
    const Lanes py = ay - tau * Lanes(edge.along.y());
    const Lanes pz = az - tau * Lanes(edge.along.z());
    const Lanes square = fma(px, px, fma(py, py, pz * pz));
    const Lanes line = root(square);
    const Lanes dot = fma(tau, tau + Lanes(edge.length), square);
    flagged_ = flagged_ | ((line < Lanes(near_edge)) & (dot < Lanes(0.0)));
    angle_of(Lanes(edge.length) * line, dot).store(to);
    line.store(to + lanes);
    tau.store(to + 2 * lanes);
  }

  const Surface& surface_;
  Lanes x_, y_, z_;
  double* distance_;
  double* edge_;
  Lanes sum_ = Lanes(0.0);
  Mask flagged_;
};

/// The weights of a face for one point, with care.
inline void view_weights_of(const Surface& surface, const PointTerms& point, std::size_t f,
                            double (&weights)[3]) {
  const Surface::Face& face = surface.faces[f];
  const FaceTerms<double>& terms = point.face(f);
  EdgeView<double> edges[3];
  for (std::size_t e = 0; e < 3; ++e) {
    const PointTerms::EdgeTerms& edge = point.edge(face.edges[e]);
    const double line = std::sqrt(edge.square);
    edges[e] = {angle_of(surface.edges[face.edges[e]].length * line,
                         fma(edge.tau, edge.tau_next, edge.square)),
                line, edge.tau, edge.tau_next};
  }
  view_weights(face.slope, terms.rho, terms.lambda, terms.height, edges, weights);
}

} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#endif
