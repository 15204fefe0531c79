// Maximum likelihood coordinates, several points side by side. Compiled once for each instruction
// set (Highway includes this file again and again); the best is chosen when the program runs.
//
// With u_j = (c_j - x) / d_j and the mean vector m_t of what x sees of triangle t, turned to where
// the triangle is, m_t = sum of tau_j u_j with tau_j >= 0: d_j times the mean value weights. Then
//     v_i = sum of m_t over the triangles at i,   y minimises -sum of ln(C + y . v_i / |v_i|),
//     lambda_i = 1 / (C + y . v_i / |v_i|),
//     w_j = (sum over the triangles at j of tau_j (sum over its corners of lambda_i / |v_i|)) /
//     d_j.
// The function is self-concordant: Newton's method with steps of 1 / (1 + decrement) stays where it
// is defined, and converges wherever there is a minimum.

#include "coordinates/surface_coordinates.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/maximum_likelihood.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/maximum_likelihood_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/convex_solve-inl.h"
#include "coordinates/view_angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

/// The points of a vector, once the weights of each face are known.
template <class V> class Likelihood {
public:
  /// \param scratch  scratch_size() numbers for each lane
  Likelihood(const Surface& surface, const std::vector<Index>& used, double* scratch)
      : surface_(surface), used_(used), shares_(scratch),
        direction_(shares_ + 3 * surface.faces.size() * width),
        inverse_length_(direction_ + 3 * surface.positions.size() * width),
        weights_(inverse_length_ + surface.positions.size() * width) {
    std::fill_n(direction_, 3 * surface.positions.size() * width, 0.0);
    std::fill_n(weights_, surface.positions.size() * width, 0.0);
  }

  static std::size_t scratch_size(const Surface& surface) {
    return 3 * surface.faces.size() + 5 * surface.positions.size();
  }

  /// A face: tau_j and the directions u_j of its corners.
  HWY_INLINE void add(std::size_t f, const V (&tau)[3], const Three<V> (&u)[3]) {
    V x(0.0);
    V y(0.0);
    V z(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      store_at(tau[k], shares_, 3 * f + k);
      x = fma(tau[k], u[k].x, x);
      y = fma(tau[k], u[k].y, y);
      z = fma(tau[k], u[k].z, z);
    }
    for (const Index v : surface_.faces[f].vertices) {
      store_at(load_at<V>(direction_, 3 * v) + x, direction_, 3 * v);
      store_at(load_at<V>(direction_, 3 * v + 1) + y, direction_, 3 * v + 1);
      store_at(load_at<V>(direction_, 3 * v + 2) + z, direction_, 3 * v + 2);
    }
  }

  /// \returns where there is no minimum: the weights there are of no use
  template <class Distance> auto solve_all(const Distance& distance) {
    for (const Index i : used_) {
      const Three<V> v = direction(i);
      const V inverse = V(1.0) / larger(root(dot(v, v)), V(1e-150));
      store_at(v.x * inverse, direction_, 3 * i);
      store_at(v.y * inverse, direction_, 3 * i + 1);
      store_at(v.z * inverse, direction_, 3 * i + 2);
      store_at(inverse, inverse_length_, i);
    }
    const V open = minimize();
    spread(distance);
    return open > V(0.0);
  }

  [[nodiscard]] double* weights() const { return weights_; }

private:
  static constexpr std::size_t width = sizeof(V) / sizeof(double);

  HWY_INLINE Three<V> direction(std::size_t i) const {
    return {load_at<V>(direction_, 3 * i), load_at<V>(direction_, 3 * i + 1),
            load_at<V>(direction_, 3 * i + 2)};
  }

  HWY_INLINE V lambda(std::size_t i) const {
    return V(1.0) / (V(static_cast<double>(used_.size())) + dot(y_, direction(i)));
  }

  /// \returns 1 where it has not converged.
  V minimize() {
    constexpr int most_steps = 60;
    constexpr double converged = 1e-16;
    y_ = {V(0.0), V(0.0), V(0.0)};
    V open(1.0);
    for (int step = 0; step < most_steps; ++step) {
      Three<V> first{V(0.0), V(0.0), V(0.0)};
      Symmetric<V> second{V(0.0), V(0.0), V(0.0), V(0.0), V(0.0), V(0.0)};
      for (const Index i : used_) {
        const Three<V> v = direction(i);
        const V l = lambda(i);
        const Three<V> lv{l * v.x, l * v.y, l * v.z};
        first = {first.x + lv.x, first.y + lv.y, first.z + lv.z};
        second = {fma(lv.x, lv.x, second.xx), fma(lv.x, lv.y, second.xy),
                  fma(lv.x, lv.z, second.xz), fma(lv.y, lv.y, second.yy),
                  fma(lv.y, lv.z, second.yz), fma(lv.z, lv.z, second.zz)};
      }
      const Three<V> newton = HWY_NAMESPACE::solve(second, first);
      const V square = larger(dot(newton, first), V(0.0));
      const V decrement = root(square);
      const V damped = V(1.0) / (V(1.0) + decrement);
      const V length = open * select(decrement > V(0.25), damped, V(1.0));
      y_ = {fma(length, newton.x, y_.x), fma(length, newton.y, y_.y), fma(length, newton.z, y_.z)};
      open = select(square < V(converged), V(0.0), open);
      if (none_of(open > V(0.0))) {
        break;
      }
    }
    return open;
  }

  template <class Distance> void spread(const Distance& distance) {
    for (const Index i : used_) {
      store_at(lambda(i) * load_at<V>(inverse_length_, i), inverse_length_, i);
    }
    for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
      const std::array<Index, 3>& corners = surface_.faces[f].vertices;
      const V all = load_at<V>(inverse_length_, corners[0]) +
                    load_at<V>(inverse_length_, corners[1]) +
                    load_at<V>(inverse_length_, corners[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        store_at(fma(load_at<V>(shares_, 3 * f + k), all, load_at<V>(weights_, corners[k])),
                 weights_, corners[k]);
      }
    }
    V sum(0.0);
    for (const Index i : used_) {
      const V w = load_at<V>(weights_, i) / distance(i);
      store_at(w, weights_, i);
      sum += w;
    }
    const V inverse = V(1.0) / sum;
    for (const Index i : used_) {
      store_at(load_at<V>(weights_, i) * inverse, weights_, i);
    }
  }

  const Surface& surface_;
  const std::vector<Index>& used_;
  double* shares_;
  double* direction_;
  double* inverse_length_;
  double* weights_;
  Three<V> y_;
};

/// \param positive  turn mean vectors to where their triangles are
/// \returns whether there is a minimum
bool solve_point(const Surface& surface, const std::vector<Index>& used, const PointTerms& point,
                 bool positive, std::vector<double>& weights) {
  std::vector<double> scratch(Likelihood<double>::scratch_size(surface));
  Likelihood<double> likelihood(surface, used, scratch.data());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    double tau[3];
    Three<double> u[3];
    view_weights_of(surface, point, f, tau);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = surface.faces[f].vertices[k];
      tau[k] *= point.distance(v);
      tau[k] = positive ? std::abs(tau[k]) : tau[k];
      const Vec3 direction = point.to_vertex(v) / point.distance(v);
      u[k] = {direction.x(), direction.y(), direction.z()};
    }
    likelihood.add(f, tau, u);
  }
  const bool open = likelihood.solve_all([&](Index v) { return point.distance(v); });
  std::copy_n(likelihood.weights(), weights.size(), weights.begin());
  return !open;
}

TileReport likelihood_tile(const UsedSurface& cage, std::span<const Vec3> points,
                           const WeightsOfTile& out) {
  const auto& [surface, used] = cage;
  const SixteenPoints all(points);
  const std::size_t own = LaneViews::scratch_size(surface);
  AlignedBuffer<double> scratch(own + Likelihood<Lanes>::scratch_size(surface) * lanes);
  std::array<bool, 16> again{};
  for (std::size_t first = 0; first < 16; first += lanes) {
    const Lanes x = Lanes::load(&all.x[first]);
    const Lanes y = Lanes::load(&all.y[first]);
    const Lanes z = Lanes::load(&all.z[first]);
    LaneViews views(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
    Likelihood<Lanes> likelihood(surface, used, scratch.data() + own);
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      Lanes tau[3];
      Three<Lanes> u[3];
      views.weights(f, tau);
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = surface.faces[f].vertices[k];
        const Vec3& c = surface.positions[v];
        const Lanes distance = views.distance(v);
        const Lanes inverse = Lanes(1.0) / distance;
        tau[k] = absolute(tau[k]) * distance;
        u[k] = {(Lanes(c.x()) - x) * inverse, (Lanes(c.y()) - y) * inverse,
                (Lanes(c.z()) - z) * inverse};
      }
      likelihood.add(f, tau, u);
    }
    const LaneFlags flagged = views.flagged();
    const LaneFlags open(likelihood.solve_all([&](Index v) HWY_ATTR { return views.distance(v); }));
    put_vertices(surface, likelihood.weights(), out.weights + first, out.stride);
    for (std::size_t i = 0; i < lanes; ++i) {
      again[first + i] = flagged[i] || open[i];
    }
  }
  TileReport report;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (again[i]) {
      std::vector<double> weights = weights_with_care(
          surface, points[i], i, on_cage, report,
          [&](const PointTerms& point, std::vector<double>& own_weights) {
            return solve_point(cage.surface, cage.used, point, true, own_weights) ||
                   solve_point(cage.surface, cage.used, point, false, own_weights);
          });
      put_vertices_of(surface, weights, out.weights, out.stride, i);
    }
  }
  return report;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(likelihood_tile);

namespace {

constexpr std::array<const CoordinateOption*, 2> kind_options = {&quads_option, &outside_option};

} // namespace

Result<std::shared_ptr<const Coordinates>>
maximum_likelihood_coordinates(const PolygonMesh& cage, const MaximumLikelihoodOptions& options) {
  return inside_coordinates(
      cage, options.quads, options.outside,
      [](const UsedSurface& used, std::span<const Vec3> points, const WeightsOfTile& out) {
        return HWY_DYNAMIC_DISPATCH(likelihood_tile)(used, points, out);
      });
}

constinit const CoordinateKind maximum_likelihood_kind = {
    .name = "maximum_likelihood",
    .idea = "positive weights, most likely by what the point sees of the faces; smooth",
    .quads = "center or diagonal",
    .sign = "positive",
    .reproduces = "affine maps",
    .on_cage = "interpolates",
    .outside = "refused, or at rest",
    .locality = "global",
    .made_by = "three unknowns a point",
    .cost = "14 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_inside<maximum_likelihood_coordinates, MaximumLikelihoodOptions>,
    .rule = vertex_rule,
};

} // namespace cagewright
#endif
