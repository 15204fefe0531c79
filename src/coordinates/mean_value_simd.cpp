// Mean value coordinates of sixteen points at a time: one point to a vector lane, loops over the
// vertices, edges and faces of the cage. Compiled once for each instruction set (Highway includes
// this file again and again); the best is chosen when the program runs.
//
// Derivation. Seen from the point v, a face with corners a, b, c (vectors from v) covers a
// spherical triangle with the mean vector
//     m = sum over its edges of g_e (a x b),   g_e = theta_e / (2 |a x b|),
// theta_e the angle under which the edge is seen. Writing m as w_a a + w_b b + w_c c gives the
// weights of Ju, Schaefer and Warren. With lambda the barycentric coordinates of the projection of
// v on the face's plane, h its height, A the area and delta = h / 2A,
//     S   = g_a lambda_a + g_b lambda_b + g_c lambda_c     (g_a: of the edge opposite a),
//     w_a = lambda_a S / delta + delta ((g_a - g_b) kappa_c + (g_a - g_c) kappa_b),
// kappa_b the scalar product of the edge vectors that leave b. Everything but g_e is affine in v,
// and g_e belongs to an edge: it is computed once for the two faces beside it.
//
// g_e needs no trigonometry. With y = cos(theta / 2), d_a = |a| and L the edge's length,
//     E = (d_a + d_b)^2 - L^2,   y^2 = E / (4 d_a d_b),   g = f(y) / sqrt(E d_a d_b),
// where f(y) = acos(y) / sqrt(1 - y^2) is smooth on [0, 1]: a polynomial.
//
// Two places need care, both rare enough to be dealt with on the side:
// - near an edge E falls with the square of the distance to it, but d_a + d_b - L has an absolute
//   error: E is taken from |a x b|^2 = E (d_a d_b - a.b) / 2 instead;
// - near the plane of a face, but beside the face, S cancels while delta vanishes. There the g0_e
//   of the point's projection satisfy sum g0_e lambda_e = 0 exactly, so that
//   S = sum (g_e - g0_e) lambda_e, and g_e - g0_e is h^2 times a divided difference that can be
//   had without cancellation.

#include "coordinates/mean_value_tables.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/mean_value_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// f(y) as a polynomial in y - 1/2, interpolated at the Chebyshev nodes of [0, 1]; relative errors
// 2e-16 and 8e-8. Centred on the interval the coefficients fall like 3^-k, so that Horner's rule
// loses nothing.
template <class T> struct Polynomial;

template <> struct Polynomial<double> {
  static constexpr std::array<double, 20> coefficients = {
      0x1.358e1a79ed7ep+0,   -0x1.0ded320818ad2p-1,  0x1.1da08d34f3617p-2,  -0x1.45030651cbc6p-3,
      0x1.8025d0be0f006p-4,  -0x1.d0c337068ffe1p-5,  0x1.1d9e5459be347p-5,  -0x1.631196dfe87cap-6,
      0x1.bd36a53e69e98p-7,  -0x1.1900d79705068p-7,  0x1.64aaaca69a765p-8,  -0x1.c6acbbed667ccp-9,
      0x1.22582c8c77468p-9,  -0x1.74a79a89c767fp-10, 0x1.eba8af19c3cbdp-11, -0x1.3d31db6e9141ep-11,
      0x1.4809cc4212f4ep-12, -0x1.a832dd43cffb8p-13, 0x1.23dba739d7593p-12, -0x1.7b9dd86667d49p-13};
};

template <> struct Polynomial<float> {
  static constexpr std::array<float, 9> coefficients = {
      0x1.358e1ap+0F,  -0x1.0decfep-1F, 0x1.1da04ep-2F,  -0x1.452c74p-3F, 0x1.805a7ep-4F,
      -0x1.c7a1cep-5F, 0x1.17d084p-5F,  -0x1.bfda94p-6F, 0x1.1990aap-6F};
};

// Distances are in the units of the tables, whose diagonal is in [0.5, 1).
template <class T> struct Limits;

template <> struct Limits<double> {
  // Nearer than this to the cage a point lies on it. The rounding of its coordinates moves a point
  // by 1e-16; the weights beyond are good to about that over the distance.
  static constexpr double on_surface = 2e-15;
  // Where d_a + d_b exceeds L by less than this fraction of L, E is computed the careful way.
  static constexpr double near_edge = 1e-4;
  // Nearer than this to the plane of a face it is worth asking whether S cancels: above, the
  // weights lose less than three digits.
  static constexpr double near_plane = 2e-3;
  static constexpr double tiny = 1e-60; // below all that is not on the surface, above underflow
  // Weights whose sum is smaller than this share of their sizes are noise.
  static constexpr double defined = 1e-11;
};

template <> struct Limits<float> {
  static constexpr float on_surface = 4e-7F;
  static constexpr float near_edge = 2e-2F;
  static constexpr float near_plane = 1e-2F;
  static constexpr float tiny = 1e-20F;
  static constexpr float defined = 1e-5F;
};

/// 1 / sqrt(v), by hardware where its approximation is good, v > 0.
template <class D, class V> HWY_INLINE V reciprocal_sqrt(D d, V v) {
#if HWY_TARGET == HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == 8 && hn::MaxLanes(D()) == 8) {
    // 14 bits from the table, 42 after the first step (of third order), 53 after the second.
    const V r0{_mm512_rsqrt14_pd(v.raw)};
    const V e0 = hn::NegMulAdd(hn::Mul(v, r0), r0, hn::Set(d, 1.0));
    const V r1 =
        hn::MulAdd(hn::Mul(r0, e0), hn::MulAdd(e0, hn::Set(d, 0.375), hn::Set(d, 0.5)), r0);
    const V e1 = hn::NegMulAdd(hn::Mul(v, r1), r1, hn::Set(d, 1.0));
    return hn::MulAdd(hn::Mul(r1, e1), hn::Set(d, 0.5), r1);
  } else if constexpr (sizeof(hn::TFromD<D>) == 4 && hn::MaxLanes(D()) == 16) {
    const V r0{_mm512_rsqrt14_ps(v.raw)};
    const V e0 = hn::NegMulAdd(hn::Mul(v, r0), r0, hn::Set(d, 1.0F));
    return hn::MulAdd(hn::Mul(r0, e0), hn::Set(d, 0.5F), r0);
  }
#endif
  using T = hn::TFromD<D>;
  return hn::Div(hn::Set(d, T(1)), hn::Sqrt(v));
}

/// a / b, likewise.
template <class D, class V> HWY_INLINE V divide(D d, V a, V b) {
#if HWY_TARGET == HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == 8 && hn::MaxLanes(D()) == 8) {
    const V r0{_mm512_rcp14_pd(b.raw)};
    const V e = hn::NegMulAdd(b, r0, hn::Set(d, 1.0));
    const V r1 = hn::MulAdd(r0, hn::MulAdd(e, e, e), r0);
    const V q = hn::Mul(a, r1);
    return hn::MulAdd(hn::NegMulAdd(b, q, a), r1, q);
  } else if constexpr (sizeof(hn::TFromD<D>) == 4 && hn::MaxLanes(D()) == 16) {
    const V r{_mm512_rcp14_ps(b.raw)};
    const V q = hn::Mul(a, r);
    return hn::MulAdd(hn::NegMulAdd(b, q, a), r, q);
  }
#endif
  (void)d;
  return hn::Div(a, b);
}

/// Where on the cage a point lies, if it does.
struct Place {
  enum Kind : std::uint8_t { vertex, edge, face, nowhere };
  Kind kind = nowhere;
  std::size_t index = 0;
};

/// The points of one vector register, and the sums under way for them.
template <class T> class VectorSolver {
  using D = hn::CappedTag<T, 16>;
  using V = hn::VFromD<D>;
  using Tables = MeanValueTables<T>;

public:
  static constexpr std::size_t lanes = hn::MaxLanes(D());

  VectorSolver(const MeanValueSolver::Tables& cage, const Tables& tables,
               const PointTile<T>& points, std::size_t first, T* scratch)
      : cage_(cage), tables_(tables), px_(hn::Load(d_, points.x.data() + first)),
        py_(hn::Load(d_, points.y.data() + first)), pz_(hn::Load(d_, points.z.data() + first)) {
    weight_ = scratch;
    distance_ = weight_ + tables.vertices.size() * lanes;
    inverse_distance_ = distance_ + tables.vertices.size() * lanes;
    g_ = inverse_distance_ + tables.vertices.size() * lanes;
  }

  /// Numbers of scratch memory that a solver needs.
  static std::size_t scratch_size(const Tables& tables) {
    return (3 * tables.vertices.size() + tables.edges.size()) * lanes;
  }

  template <class Out>
  void solve(const WeightsOut<Out>& out, std::size_t first, TileReport& report) {
    measure_vertices();
    measure_edges();
    add_faces();
    put_on_surface();
    share_middles();
    normalize(out, first, report);
  }

private:
  V constant(T value) const { return hn::Set(d_, value); }

  V apply(const typename Tables::Affine& f) const {
    return hn::MulAdd(
        constant(f[0]), px_,
        hn::MulAdd(constant(f[1]), py_, hn::MulAdd(constant(f[2]), pz_, constant(f[3]))));
  }

  /// The terms of the polynomial c[first], c[first + step]..., in powers of `x`.
  template <std::size_t first, std::size_t step> V terms(V x) const {
    constexpr auto& c = Polynomial<T>::coefficients;
    constexpr std::size_t last = (c.size() - 1 - first) / step;
    V value = constant(c[first + last * step]);
    // Unrolled by hand: the compiler would leave the loop alone.
    [&]<std::size_t... k>(std::index_sequence<k...>) HWY_ATTR {
      ((value = hn::MulAdd(value, x, constant(c[first + (last - 1 - k) * step]))), ...);
    }
    (std::make_index_sequence<last>());
    return value;
  }

  /// f(y). Horner's rule alone is one long chain of dependent operations, longer than a processor
  /// looks ahead; four chains side by side take half the time.
  V polynomial(V y) const {
    const V x = hn::Sub(y, constant(T(0.5)));
    const V x2 = hn::Mul(x, x);
    const V x4 = hn::Mul(x2, x2);
    const V low = hn::MulAdd(terms<1, 4>(x4), x, terms<0, 4>(x4));
    const V high = hn::MulAdd(terms<3, 4>(x4), x, terms<2, 4>(x4));
    return hn::MulAdd(high, x2, low);
  }

  /// Remembers which lanes lie on a vertex, edge or face; a vertex before an edge before a face.
  template <class M>
  HWY_NOINLINE void remember(M on, typename Place::Kind kind, std::size_t index) {
    alignas(64) std::array<T, lanes> flags;
    hn::Store(hn::IfThenElseZero(on, constant(T(1))), d_, flags.data());
    for (std::size_t i = 0; i < lanes; ++i) {
      if (flags[i] != 0 && kind < places_[i].kind) {
        places_[i] = {kind, index};
        any_on_surface_ = true;
      }
    }
  }

  void measure_vertices() {
    const V limit = constant(Limits<T>::on_surface * Limits<T>::on_surface);
    for (std::size_t i = 0; i < tables_.vertices.size(); ++i) {
      const auto& vertex = tables_.vertices[i];
      const V x = hn::Sub(constant(vertex.x), px_);
      const V y = hn::Sub(constant(vertex.y), py_);
      const V z = hn::Sub(constant(vertex.z), pz_);
      V square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
      const auto on = hn::Lt(square, limit);
      if (HWY_UNLIKELY(!hn::AllFalse(d_, on))) {
        if (cage_.used[i] != 0) {
          remember(on, Place::vertex, i);
        }
        square = hn::Max(square, limit);
      }
      const V inverse = reciprocal_sqrt(d_, square);
      hn::Store(inverse, d_, inverse_distance_ + i * lanes);
      hn::Store(hn::Mul(square, inverse), d_, distance_ + i * lanes);
      hn::Store(hn::Zero(d_), d_, weight_ + i * lanes);
    }
  }

  void measure_edges() {
    for (std::size_t i = 0; i < tables_.edges.size(); ++i) {
      const auto& edge = tables_.edges[i];
      const V da = hn::Load(d_, distance_ + edge.from * lanes);
      const V db = hn::Load(d_, distance_ + edge.to * lanes);
      const V sum = hn::Add(da, db);
      const V length = constant(edge.length);
      const V gap = hn::Sub(sum, length);
      const V product = hn::Mul(da, db);
      V e = hn::Mul(gap, hn::Add(sum, length));
      const auto near = hn::Lt(gap, constant(Limits<T>::near_edge * edge.length));
      if (HWY_UNLIKELY(!hn::AllFalse(d_, near))) {
        e = hn::IfThenElse(near, careful_e(i, product, near), e);
      }
      const V ep = hn::Mul(e, product);
      const V root = reciprocal_sqrt(d_, ep);
      const V inverse_product = hn::Mul(hn::Load(d_, inverse_distance_ + edge.from * lanes),
                                        hn::Load(d_, inverse_distance_ + edge.to * lanes));
      const V y = hn::Mul(hn::Mul(ep, root), hn::Mul(inverse_product, constant(T(0.5))));
      hn::Store(hn::Mul(polynomial(y), root), d_, g_ + i * lanes);
    }
  }

  /// E from |a x b|, which falls with the distance to the edge and not with its square.
  template <class M> HWY_NOINLINE V careful_e(std::size_t index, V product, M near) {
    const auto& edge = tables_.edges[index];
    const auto& from = tables_.vertices[edge.from];
    const V ax = hn::Sub(constant(from.x), px_);
    const V ay = hn::Sub(constant(from.y), py_);
    const V az = hn::Sub(constant(from.z), pz_);
    const V ex = constant(edge.x);
    const V ey = constant(edge.y);
    const V ez = constant(edge.z);
    const V cx = hn::Sub(hn::Mul(ay, ez), hn::Mul(az, ey));
    const V cy = hn::Sub(hn::Mul(az, ex), hn::Mul(ax, ez));
    const V cz = hn::Sub(hn::Mul(ax, ey), hn::Mul(ay, ex));
    const V cross = hn::MulAdd(cx, cx, hn::MulAdd(cy, cy, hn::Mul(cz, cz)));
    // a.b = a.(a + e), both sums small near the vertex `from`.
    const V dot = hn::MulAdd(ax, hn::Add(ax, ex),
                             hn::MulAdd(ay, hn::Add(ay, ey), hn::Mul(az, hn::Add(az, ez))));
    const V limit = constant(Limits<T>::on_surface * edge.length);
    const auto beside = hn::Lt(dot, hn::Zero(d_));
    const auto on = hn::And(hn::And(near, beside), hn::Lt(cross, hn::Mul(limit, limit)));
    if (!hn::AllFalse(d_, on)) {
      remember(on, Place::edge, index);
    }
    return e_of(cross, dot, product);
  }

  /// E = 2 (d_a d_b + a.b), and where that cancels from |a x b|^2.
  V e_of(V cross, V dot, V product) const {
    const auto beside = hn::Lt(dot, hn::Zero(d_));
    const V tiny = constant(Limits<T>::tiny);
    const V across = divide(d_, cross, hn::Max(hn::Sub(product, dot), tiny));
    const V half = hn::IfThenElse(beside, across, hn::Add(product, dot));
    return hn::Max(hn::Add(half, half), tiny);
  }

  void add_faces() {
    const auto outside = hn::Gt(hn::MulAdd(px_, px_, hn::MulAdd(py_, py_, hn::Mul(pz_, pz_))),
                                constant(tables_.outside2));
    // Far outside the cage the same relative height is meant.
    const V reach = hn::Mul(
        constant(Limits<T>::near_plane),
        hn::Max(constant(T(1)), hn::Add(hn::Abs(px_), hn::Add(hn::Abs(py_), hn::Abs(pz_)))));
    if (HWY_UNLIKELY(!hn::AllFalse(d_, outside))) {
      add_faces_outside(outside, reach);
      return;
    }
    for (std::size_t i = 0; i < tables_.faces.size(); ++i) {
      const auto& face = tables_.faces[i];
      const FaceTerms f = terms_of(i, reach);
      add_weight(face.vertices[0], f.lambda[0], f.quotient, f.delta, f.rest[0]);
      add_weight(face.vertices[1], f.lambda[1], f.quotient, f.delta, f.rest[1]);
      add_weight(face.vertices[2], f.lambda[2], f.quotient, f.delta, f.rest[2]);
    }
  }

  /// A face's share of the weight of its corner i: lambda[i] * quotient + delta * rest[i].
  struct FaceTerms {
    V lambda[3];
    V quotient;
    V delta;
    V rest[3];
  };

  HWY_INLINE FaceTerms terms_of(std::size_t index, V reach) {
    const auto& face = tables_.faces[index];
    const V la = apply(face.lambda_0);
    const V lb = apply(face.lambda_1);
    const V lc = hn::Sub(hn::Sub(constant(T(1)), la), lb);
    const V delta = apply(face.delta);
    const V ga = hn::Load(d_, g_ + face.edges[0] * lanes);
    const V gb = hn::Load(d_, g_ + face.edges[1] * lanes);
    const V gc = hn::Load(d_, g_ + face.edges[2] * lanes);
    const V s = hn::MulAdd(ga, la, hn::MulAdd(gb, lb, hn::Mul(gc, lc)));
    const auto near = hn::Lt(hn::Mul(hn::Abs(delta), constant(face.area2)), reach);
    const V quotient = HWY_UNLIKELY(!hn::AllFalse(d_, near))
                           ? careful_quotient(index, {la, lb, lc}, {ga, gb, gc}, delta, s)
                           : divide(d_, s, delta);
    const V ka = hn::Mul(hn::Sub(gb, gc), constant(face.kappa[0]));
    const V kb = hn::Mul(hn::Sub(gc, ga), constant(face.kappa[1]));
    const V kc = hn::Mul(hn::Sub(ga, gb), constant(face.kappa[2]));
    return {{la, lb, lc}, quotient, delta, {hn::Sub(kc, kb), hn::Sub(ka, kc), hn::Sub(kb, ka)}};
  }

  /// The same where some points are outside the sphere round the cage. Their weights are all taken
  /// times R^4, R the distance from the origin.
  template <class M> HWY_NOINLINE void add_faces_outside(M outside, V reach) {
    const V square = hn::IfThenElse(
        outside, hn::MulAdd(px_, px_, hn::MulAdd(py_, py_, hn::Mul(pz_, pz_))), constant(T(1)));
    const V scale = hn::Mul(square, square);
    auto all_far = outside;
    V far_sum = apply(tables_.flux);
    for (std::size_t i = 0; i < tables_.faces.size(); ++i) {
      const auto& face = tables_.faces[i];
      const V x = hn::Sub(constant(face.center.x), px_);
      const V y = hn::Sub(constant(face.center.y), py_);
      const V z = hn::Sub(constant(face.center.z), pz_);
      const V distance2 = hn::IfThenElse(outside, hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))),
                                         constant(T(0)));
      const V ratio2 = hn::Mul(distance2, constant(1 / face.radius2));
      const auto far = hn::Ge(ratio2, constant(tables_.rules.back().least_ratio2));
      all_far = hn::And(all_far, far);
      if (!hn::AllTrue(d_, far)) {
        const FaceTerms f = terms_of(i, reach);
        for (std::size_t k = 0; k < 3; ++k) {
          const V weight = hn::MulAdd(f.lambda[k], f.quotient, hn::Mul(f.delta, f.rest[k]));
          add_to(face.vertices[k], hn::IfThenZeroElse(far, hn::Mul(weight, scale)));
        }
      }
      if (!hn::AllFalse(d_, far)) {
        const T least = hn::GetLane(
            hn::MinOfLanes(d_, hn::IfThenElse(far, ratio2, constant(hwy::HighestValue<T>()))));
        far_sum = hn::Add(far_sum, add_face_from_afar(i, square, far, least));
      }
    }
    far_sum_ = far_sum;
    from_afar_ = hn::IfThenElseZero(all_far, constant(T(1)));
  }

  /// From afar nothing of the closed form is left but round-off, while the integral itself,
  ///     w_a = h int lambda_a / r^4 dA,
  /// is smooth. Of R^4 / r^4 = 1 + t (2 R^2 - t) / r^4, with t = R^2 - r^2, the 1 is integrated
  /// exactly: summed over the cage it leaves only the volume, and the rest falls as fast as that.
  /// \returns what the face adds to the sum of all weights besides the 1.
  template <class M> V add_face_from_afar(std::size_t index, V square, M far, T least_ratio2) {
    const auto& face = tables_.faces[index];
    std::size_t choice = 0;
    while (tables_.rules[choice].least_ratio2 > least_ratio2) {
      ++choice;
    }
    V t[3]; // at the corners
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& v = tables_.vertices[face.vertices[k]];
      t[k] = hn::MulAdd(constant(2 * v.x), px_,
                        hn::MulAdd(constant(2 * v.y), py_,
                                   hn::MulSub(constant(2 * v.z), pz_, constant(v.square))));
    }
    V sum[3] = {hn::Zero(d_), hn::Zero(d_), hn::Zero(d_)};
    for (const auto& node : tables_.rules[choice].nodes) {
      const T bend = node.products[0] * face.length2[0] + node.products[1] * face.length2[1] +
                     node.products[2] * face.length2[2];
      const V here =
          hn::MulAdd(constant(node.lambda[0]), t[0],
                     hn::MulAdd(constant(node.lambda[1]), t[1],
                                hn::MulAdd(constant(node.lambda[2]), t[2], constant(bend))));
      const V r2 = hn::Sub(square, here);
      const V value = divide(d_, hn::Mul(here, hn::Add(square, r2)), hn::Mul(r2, r2));
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] = hn::MulAdd(constant(node.weighted[k]), value, sum[k]);
      }
    }
    const V flux = hn::IfThenElseZero(
        far, hn::Mul(apply(face.delta), constant(T(0.5) * face.area2 * face.area2)));
    for (std::size_t k = 0; k < 3; ++k) {
      add_to(face.vertices[k], hn::Mul(flux, hn::Add(sum[k], constant(T(1) / 3))));
    }
    return hn::Mul(flux, hn::Add(sum[0], hn::Add(sum[1], sum[2])));
  }

  void add_to(Index vertex, V value) {
    T* weight = weight_ + vertex * lanes;
    hn::Store(hn::Add(hn::Load(d_, weight), value), d_, weight);
  }

  void add_weight(Index vertex, V lambda, V quotient, V delta, V k) {
    T* weight = weight_ + vertex * lanes;
    const V sum = hn::MulAdd(lambda, quotient, hn::Load(d_, weight));
    hn::Store(hn::MulAdd(delta, k, sum), d_, weight);
  }

  /// S / delta near the plane of a face.
  HWY_NOINLINE V careful_quotient(std::size_t index, const std::array<V, 3>& lambda,
                                  const std::array<V, 3>& g, V delta, V s) {
    const auto& face = tables_.faces[index];
    const V height = hn::Mul(delta, constant(face.area2));
    const auto outside = hn::Lt(hn::Min(hn::Min(lambda[0], lambda[1]), lambda[2]), hn::Zero(d_));
    const auto touching = hn::Lt(hn::Abs(height), constant(Limits<T>::on_surface));
    const auto on = hn::AndNot(outside, touching);
    if (!hn::AllFalse(d_, on)) {
      remember(on, Place::face, index);
    }
    const V tiny = constant(Limits<T>::tiny);
    const V safe = hn::IfThenElse(hn::Lt(hn::Abs(delta), tiny), tiny, delta);
    const V quotient = divide(d_, s, safe);
    V terms = hn::Abs(hn::Mul(g[0], lambda[0]));
    terms = hn::Add(terms, hn::Abs(hn::Mul(g[1], lambda[1])));
    terms = hn::Add(terms, hn::Abs(hn::Mul(g[2], lambda[2])));
    const auto cancels = hn::And(outside, hn::Lt(hn::Abs(s), hn::Mul(terms, constant(T(0.05)))));
    if (hn::AllFalse(d_, cancels)) {
      return quotient;
    }
    V sum = hn::Zero(d_);
    for (std::size_t k = 0; k < 3; ++k) {
      const V twice_area = hn::Mul(lambda[k], constant(face.area2));
      const V change = change_of_g(face.edges[k], twice_area, hn::Mul(height, height));
      sum = hn::MulAdd(change, lambda[k], sum);
    }
    const V exact = hn::Mul(sum, hn::Mul(height, constant(face.area2)));
    return hn::IfThenElse(cancels, exact, quotient);
  }

  /// (g - g0) / h^2, where g0 belongs to the projection of the point on the plane of a face:
  /// |a0 x b0| there is `cross0`. The zero marks quantities of the projection; every difference is
  /// written as h^2 times something that does not cancel.
  V change_of_g(Index index, V cross0, V height2) const {
    const auto& edge = tables_.edges[index];
    const V tiny = constant(Limits<T>::tiny);
    const V da = hn::Load(d_, distance_ + edge.from * lanes);
    const V db = hn::Load(d_, distance_ + edge.to * lanes);
    const V da2 = hn::Mul(da, da);
    const V db2 = hn::Mul(db, db);
    const V squares = hn::Add(da2, db2);
    const V square0 =
        hn::Mul(hn::Max(hn::Sub(da2, height2), tiny), hn::Max(hn::Sub(db2, height2), tiny));
    const V inverse_product0 = reciprocal_sqrt(d_, square0);
    const V product0 = hn::Mul(square0, inverse_product0);
    const V product = hn::Mul(da, db);
    const V inverse_product = hn::Mul(hn::Load(d_, inverse_distance_ + edge.from * lanes),
                                      hn::Load(d_, inverse_distance_ + edge.to * lanes));
    const V dot = hn::Mul(hn::Sub(squares, constant(edge.length * edge.length)), constant(T(0.5)));
    const V e0 = e_of(hn::Mul(cross0, cross0), hn::Sub(dot, height2), product0);
    const V d_product = divide(d_, hn::Sub(squares, height2), hn::Add(product, product0));
    const V d_e = hn::MulAdd(constant(T(2)), d_product, constant(T(2)));
    const V e = hn::MulAdd(height2, d_e, e0);

    const V root0_2 = hn::Max(hn::Mul(e0, product0), tiny);
    const V root2 = hn::Max(hn::Mul(e, product), tiny);
    const V inverse_root0 = reciprocal_sqrt(d_, root0_2);
    const V inverse_root = reciprocal_sqrt(d_, root2);
    const V root0 = hn::Mul(root0_2, inverse_root0); // 2 y0 d_a0 d_b0
    const V root = hn::Mul(root2, inverse_root);
    const V d_root2 = hn::MulAdd(d_e, product, hn::Mul(e0, d_product));
    const V d_inverse_root = hn::Neg(
        divide(d_, hn::Mul(hn::Mul(d_root2, inverse_root), inverse_root0), hn::Add(root, root0)));

    const V half = constant(T(0.5));
    const V y0 = hn::Mul(half, hn::Mul(root0, inverse_product0));
    const V y = hn::Mul(half, hn::Mul(root, inverse_product));
    const V d_y2 = hn::Mul(hn::Mul(constant(T(0.25)), hn::Mul(inverse_product, inverse_product0)),
                           hn::Sub(hn::Mul(d_e, product0), hn::Mul(e0, d_product)));
    const V d_y = divide(d_, d_y2, hn::Add(y, y0));

    // f(y0) and the divided difference f[y, y0], by Horner's rule.
    constexpr auto& c = Polynomial<T>::coefficients;
    const V x = hn::Sub(y, half);
    const V x0 = hn::Sub(y0, half);
    V f0 = constant(c.back());
    V d_f = hn::Zero(d_);
    for (std::size_t k = c.size() - 1; k-- > 0;) {
      d_f = hn::MulAdd(d_f, x, f0);
      f0 = hn::MulAdd(f0, x0, constant(c[k]));
    }
    return hn::MulAdd(f0, d_inverse_root, hn::Mul(hn::Mul(d_f, d_y), inverse_root));
  }

  /// Points on the cage take the barycentric coordinates of where they lie.
  void put_on_surface() {
    if (!any_on_surface_) {
      return;
    }
    alignas(64) std::array<T, lanes> x, y, z;
    hn::Store(px_, d_, x.data());
    hn::Store(py_, d_, y.data());
    hn::Store(pz_, d_, z.data());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Place place = places_[lane];
      if (place.kind == Place::nowhere) {
        continue;
      }
      for (std::size_t i = 0; i < tables_.vertices.size(); ++i) {
        weight_[i * lanes + lane] = 0;
      }
      if (place.kind == Place::vertex) {
        weight_[place.index * lanes + lane] = 1;
      } else if (place.kind == Place::edge) {
        const auto& edge = tables_.edges[place.index];
        const auto& from = tables_.vertices[edge.from];
        const T along =
            (x[lane] - from.x) * edge.x + (y[lane] - from.y) * edge.y + (z[lane] - from.z) * edge.z;
        const T share = std::clamp(along / (edge.length * edge.length), T(0), T(1));
        weight_[edge.from * lanes + lane] = 1 - share;
        weight_[edge.to * lanes + lane] = share;
      } else {
        const auto& face = tables_.faces[place.index];
        const auto at = [&](const typename Tables::Affine& f) {
          return std::clamp(f[0] * x[lane] + f[1] * y[lane] + f[2] * z[lane] + f[3], T(0), T(1));
        };
        const T a = at(face.lambda_0);
        const T b = at(face.lambda_1);
        weight_[face.vertices[0] * lanes + lane] = a;
        weight_[face.vertices[1] * lanes + lane] = b;
        weight_[face.vertices[2] * lanes + lane] = std::max(T(0), 1 - a - b);
      }
    }
  }

  /// The corners of a quad share the weight of its middle.
  void share_middles() {
    for (std::size_t q = 0; q < cage_.quads.size(); ++q) {
      const V share =
          hn::Mul(constant(T(0.25)), hn::Load(d_, weight_ + (cage_.cage_vertices + q) * lanes));
      for (const Index corner : cage_.quads[q]) {
        T* weight = weight_ + corner * lanes;
        hn::Store(hn::Add(hn::Load(d_, weight), share), d_, weight);
      }
    }
  }

  template <class Out>
  void normalize(const WeightsOut<Out>& out, std::size_t first, TileReport& report) {
    V sum = hn::Zero(d_);
    V size = hn::Zero(d_);
    for (std::size_t i = 0; i < cage_.cage_vertices; ++i) {
      const V weight = hn::Load(d_, weight_ + i * lanes);
      sum = hn::Add(sum, weight);
      size = hn::Add(size, hn::Abs(weight));
    }
    const auto from_afar = hn::Gt(from_afar_, hn::Zero(d_));
    sum = hn::IfThenElse(from_afar, far_sum_, sum);
    const V least = hn::IfThenElse(from_afar, constant(tables_.least_flux),
                                   hn::Mul(size, constant(Limits<T>::defined)));
    // Only around a broken cage, or for a point that is no number, do the weights not add up.
    const auto defined =
        hn::And(hn::Gt(hn::Abs(sum), least), hn::Lt(size, constant(hwy::HighestValue<T>())));
    const V inverse = hn::Div(constant(T(1)), hn::IfThenElse(defined, sum, constant(T(1))));
    for (std::size_t i = 0; i < cage_.cage_vertices; ++i) {
      const V weight = hn::Mul(hn::Load(d_, weight_ + i * lanes), inverse);
      store(hn::IfThenElseZero(defined, weight), out.first + i * out.stride + first);
    }
    alignas(64) std::array<T, lanes> flags;
    hn::Store(hn::IfThenElseZero(defined, constant(T(1))), d_, flags.data());
    for (std::size_t i = 0; i < lanes; ++i) {
      const unsigned bit = 1U << (first + i);
      report.undefined = static_cast<std::uint16_t>(report.undefined | (flags[i] != 0 ? 0 : bit));
      report.on_surface = static_cast<std::uint16_t>(report.on_surface |
                                                     (places_[i].kind != Place::nowhere ? bit : 0));
    }
  }

  void store(V values, T* to) const { hn::StoreU(values, d_, to); }
  template <class Out>
  requires(!std::is_same_v<Out, T>) void store(V values, Out* to) const {
    const hn::Rebind<Out, D> narrow;
    hn::StoreU(hn::DemoteTo(narrow, values), narrow, to);
  }

  static constexpr D d_{};
  const MeanValueSolver::Tables& cage_;
  const Tables& tables_;
  V px_, py_, pz_;
  V far_sum_ = hn::Zero(d_);   // of the weights times R^4, for points from which every face is far
  V from_afar_ = hn::Zero(d_); // 1 for these points
  T* weight_;
  T* distance_;
  T* inverse_distance_;
  T* g_;
  std::array<Place, lanes> places_;
  bool any_on_surface_ = false;
};

template <class T, class Out>
TileReport tile_of(const MeanValueSolver::Tables& cage, const MeanValueTables<T>& tables,
                   const PointTile<T>& points, const WeightsOut<Out>& out) {
  using Solver = VectorSolver<T>;
  AlignedBuffer<T> scratch(Solver::scratch_size(tables));
  TileReport report;
  for (std::size_t first = 0; first < 16; first += Solver::lanes) {
    Solver(cage, tables, points, first, scratch.data()).solve(out, first, report);
  }
  return report;
}

TileReport in_double(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                     WeightsOut<double> out) {
  return tile_of(cage, cage.in_double, points, out);
}
TileReport double_to_float(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           WeightsOut<float> out) {
  return tile_of(cage, cage.in_double, points, out);
}
TileReport in_float(const MeanValueSolver::Tables& cage, const PointTile<float>& points,
                    WeightsOut<float> out) {
  return tile_of(cage, cage.in_float, points, out);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(in_double);
HWY_EXPORT(double_to_float);
HWY_EXPORT(in_float);

TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           WeightsOut<double> out) {
  return HWY_DYNAMIC_DISPATCH(in_double)(cage, points, out);
}
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           WeightsOut<float> out) {
  return HWY_DYNAMIC_DISPATCH(double_to_float)(cage, points, out);
}
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<float>& points,
                           WeightsOut<float> out) {
  return HWY_DYNAMIC_DISPATCH(in_float)(cage, points, out);
}

} // namespace cagewright
#endif
