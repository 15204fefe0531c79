// Maximum entropy coordinates, several points side by side. Compiled once for each instruction set
// (Highway includes this file again and again); the best is chosen when the program runs.
//
//     w_i = m_i exp(-l . z_i) / Z,   z_i = c_i - x,   l the minimum of ln Z,
//     ln m_i = sum over the faces at i of (s - ln rho_f),   s the mean of ln rho_f over all faces,
//     rho_f = (the areas of the three triangles x, a, b) - (the area of f), zero on f alone.
//
// Without s the product would have the unit of a length to the power of the valence. ln Z is smooth
// and strictly convex: Newton's method with backtracking.

#include "coordinates/surface_coordinates.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/maximum_entropy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/maximum_entropy_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/convex_solve-inl.h"
#include "coordinates/triangle_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

/// Nearer than this to the cage, in diagonals, the weights are the barycentric coordinates there.
constexpr double at_cage = 1e-9;

/// rho_f, with sigma_e = rho_e length_e: half the sum of sqrt(sigma^2 + h^2 length^2) - sigma, of
/// which each falls with h^2 where sigma is positive.
template <class V> HWY_INLINE V excess(const Surface::Face& face, const FaceTerms<V>& terms) {
  const V height2 = terms.height * terms.height;
  V sum(0.0);
  for (std::size_t e = 0; e < 3; ++e) {
    const V length(face.length[e]);
    const V sigma = terms.rho[e] * length;
    const V high = height2 * length * length;
    const V whole = root(fma(sigma, sigma, high));
    const V size = whole + absolute(sigma);
    sum += select(sigma > V(0.0), high / larger(size, V(1e-290)), size);
  }
  return sum * V(0.5);
}

/// The logarithms of the prior from those of rho_f, which are in `logs` for each face.
template <class V> void gather_prior(const Surface& surface, const double* logs, double* prior) {
  V mean(0.0);
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    mean += load_at<V>(logs, f);
  }
  mean *= V(1.0 / static_cast<double>(surface.faces.size()));
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    store_at(V(0.0), prior, i);
  }
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const V more = mean - load_at<V>(logs, f);
    for (const Index v : surface.faces[f].vertices) {
      store_at(load_at<V>(prior, v) + more, prior, v);
    }
  }
}

/// Newton's method for the points of a vector. Vertices without faces take no part.
template <class V> class Entropy {
public:
  Entropy(const Surface& surface, const std::vector<Index>& used, const Three<V>& x,
          const double* prior, double* weights)
      : surface_(surface), used_(used), x_(x), prior_(prior), weights_(weights) {}

  /// Leaves the weights, whose sum is 1. \returns where it has not converged: those are of no use.
  auto solve_all() {
    constexpr int most_steps = 200;
    constexpr double converged = 1e-16;
    constexpr double longest_step = 30;
    Three<V> at{V(0.0), V(0.0), V(0.0)};
    Three<V> direction = at;
    V value(1e300);
    V slope(0.0);
    V step(0.0);
    V open(1.0); // 0 where it is done
    for (int i = 0; i < most_steps; ++i) {
      const Three<V> trial{fma(step, direction.x, at.x), fma(step, direction.y, at.y),
                           fma(step, direction.z, at.z)};
      const V now = evaluate(trial);
      // Rounding of the value may not keep good steps out.
      const V slack = V(1e-14) * (V(1.0) + absolute(now));
      const auto falls = now < fma(V(1e-4) * step, slope, value) + slack;
      const Three<V> whole =
          HWY_NAMESPACE::solve(hessian_, {-gradient_.x, -gradient_.y, -gradient_.z});
      const V decrement = -dot(whole, gradient_);
      // By a vertex all weights but one are nearly 0 at first: there is no curvature to go by, and
      // a step may be far too long. So long a one changes weights by factors of e^30.
      const V length = root(dot(whole, whole));
      const V shortened = V(longest_step) / larger(length, V(longest_step));
      const Three<V> newton{whole.x * shortened, whole.y * shortened, whole.z * shortened};
      at = {select(falls, trial.x, at.x), select(falls, trial.y, at.y),
            select(falls, trial.z, at.z)};
      direction = {select(falls, newton.x, direction.x), select(falls, newton.y, direction.y),
                   select(falls, newton.z, direction.z)};
      value = select(falls, now, value);
      slope = select(falls, -decrement * shortened, slope);
      step = select(falls, open, step * V(0.5));
      // One more whole step: it squares what is left.
      const auto is_done = select(falls, decrement, V(1.0)) < V(converged);
      const V ends = select(is_done, open, V(0.0));
      at = {fma(ends, direction.x, at.x), fma(ends, direction.y, at.y),
            fma(ends, direction.z, at.z)};
      open = select(is_done, V(0.0), open);
      step = open * step;
      value = select(is_done, V(1e300), value); // what comes is accepted, and is the same
      if (none_of(open > V(0.0))) {
        break;
      }
    }
    (void)evaluate(at);
    normalize();
    return open > V(0.0);
  }

private:
  /// ln Z, with gradient and Hessian, and the terms of Z in weights_.
  HWY_INLINE V evaluate(const Three<V>& at) {
    V most(-1e300);
    for (const Index i : used_) {
      const Vec3& c = surface_.positions[i];
      const V z = fma(V(c.x()) - x_.x, at.x, fma(V(c.y()) - x_.y, at.y, (V(c.z()) - x_.z) * at.z));
      const V exponent = load_at<V>(prior_, i) - z;
      most = larger(most, exponent);
      store_at(exponent, weights_, i);
    }
    V sum(0.0);
    Three<V> first{V(0.0), V(0.0), V(0.0)};
    Symmetric<V> second{V(0.0), V(0.0), V(0.0), V(0.0), V(0.0), V(0.0)};
    for (const Index i : used_) {
      const Vec3& c = surface_.positions[i];
      const V w = exponential(load_at<V>(weights_, i) - most);
      store_at(w, weights_, i);
      const Three<V> z{V(c.x()) - x_.x, V(c.y()) - x_.y, V(c.z()) - x_.z};
      const Three<V> wz{w * z.x, w * z.y, w * z.z};
      sum += w;
      first = {first.x + wz.x, first.y + wz.y, first.z + wz.z};
      second = {fma(wz.x, z.x, second.xx), fma(wz.x, z.y, second.xy), fma(wz.x, z.z, second.xz),
                fma(wz.y, z.y, second.yy), fma(wz.y, z.z, second.yz), fma(wz.z, z.z, second.zz)};
    }
    const V inverse = V(1.0) / sum;
    const Three<V> mean{first.x * inverse, first.y * inverse, first.z * inverse};
    gradient_ = {-mean.x, -mean.y, -mean.z};
    hessian_ = {second.xx * inverse - mean.x * mean.x, second.xy * inverse - mean.x * mean.y,
                second.xz * inverse - mean.x * mean.z, second.yy * inverse - mean.y * mean.y,
                second.yz * inverse - mean.y * mean.z, second.zz * inverse - mean.z * mean.z};
    // What rounding leaves of the differences: below it, the gradient alone shows the way.
    const V noise = V(1e-15) * (dot(mean, mean) + V(1e-30));
    hessian_.xx += noise;
    hessian_.yy += noise;
    hessian_.zz += noise;
    inverse_sum_ = inverse;
    return most + logarithm(sum);
  }

  void normalize() {
    for (const Index i : used_) {
      store_at(load_at<V>(weights_, i) * inverse_sum_, weights_, i);
    }
  }

  const Surface& surface_;
  const std::vector<Index>& used_;
  Three<V> x_;
  const double* prior_;
  double* weights_;
  Three<V> gradient_;
  Symmetric<V> hessian_;
  V inverse_sum_;
};

/// \returns whether it has converged
bool solve_inside(const Surface& surface, const std::vector<Index>& used, const PointTerms& point,
                  const Vec3& x, std::vector<double>& weights) {
  std::vector<double> logs;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    logs.push_back(logarithm(larger(excess(surface.faces[f], point.face(f)), 1e-290)));
  }
  std::vector<double> prior(surface.positions.size());
  gather_prior<double>(surface, logs.data(), prior.data());
  Entropy<double> entropy(surface, used, {x.x(), x.y(), x.z()}, prior.data(), weights.data());
  return !entropy.solve_all();
}

TileReport entropy_tile(const UsedSurface& cage, std::span<const Vec3> points,
                        const WeightsOfTile& out) {
  const auto& [surface, used] = cage;
  const std::size_t vertices = surface.positions.size();
  const SixteenPoints all(points);
  const std::size_t own = LanePoints::scratch_size(surface);
  AlignedBuffer<double> scratch(own + (2 * vertices + surface.faces.size()) * lanes);
  double* const prior = scratch.data() + own;
  double* const weights = prior + vertices * lanes;
  double* const logs = weights + vertices * lanes;
  std::array<bool, 16> again{};
  for (std::size_t first = 0; first < 16; first += lanes) {
    LanePoints lane(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
    Lanes lowest(1e300); // LanePoints flags what is far nearer only
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const FaceTerms<Lanes> terms = lane.face(f);
      lowest = smaller(lowest, absolute(terms.height));
      logarithm(larger(excess(surface.faces[f], terms), Lanes(1e-290))).store(logs + f * lanes);
    }
    const LaneFlags flagged = lane.flagged();
    const LaneFlags near(lowest < Lanes(at_cage));
    gather_prior<Lanes>(surface, logs, prior);
    std::fill_n(weights, vertices * lanes, 0.0);
    Entropy<Lanes> entropy(
        surface, used,
        {Lanes::load(&all.x[first]), Lanes::load(&all.y[first]), Lanes::load(&all.z[first])}, prior,
        weights);
    const LaneFlags open(entropy.solve_all());
    put_vertices(surface, weights, out.weights + first, out.stride);
    for (std::size_t i = 0; i < lanes; ++i) {
      again[first + i] = flagged[i] || near[i] || open[i];
    }
  }
  TileReport report;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (again[i]) {
      std::vector<double> weights_here = weights_with_care(
          surface, points[i], i, at_cage, report,
          [&](const PointTerms& point, std::vector<double>& own_weights) {
            return solve_inside(cage.surface, cage.used, point, points[i], own_weights);
          });
      put_vertices_of(surface, weights_here, out.weights, out.stride, i);
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

HWY_EXPORT(entropy_tile);

namespace {

constexpr std::array<const CoordinateOption*, 2> kind_options = {&quads_option, &outside_option};

} // namespace

Result<std::shared_ptr<const Coordinates>>
maximum_entropy_coordinates(const PolygonMesh& cage, const MaximumEntropyOptions& options) {
  return inside_coordinates(
      cage, options.quads, options.outside,
      [](const UsedSurface& used, std::span<const Vec3> points, const WeightsOfTile& out) {
        return HWY_DYNAMIC_DISPATCH(entropy_tile)(used, points, out);
      });
}

constinit const CoordinateKind maximum_entropy_kind = {
    .name = "maximum_entropy",
    .idea = "of all positive weights that give the point, the least biased; bent little elsewhere",
    .quads = "center or diagonal",
    .sign = "positive",
    .reproduces = "affine maps",
    .on_cage = "interpolates",
    .outside = "refused, or at rest",
    .locality = "global, falls fast",
    .made_by = "three unknowns a point",
    .cost = "15 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_inside<maximum_entropy_coordinates, MaximumEntropyOptions>,
    .rule = vertex_rule,
};

} // namespace cagewright
#endif
