// Somigliana coordinates, several points side by side. Compiled once for each instruction set
// (Highway includes this file again and again); the best is chosen when the program runs.
//
// Phi_i = minus the integral of hat_i T and k_t = the integral of U n over triangle t, with U
// Kelvin's solution of linear elasticity and T its traction. Over a triangle both are made of solid
// angle and edge integrals (docs/coordinates.md): with L3_e the integral of 1 / r^3 along edge e,
// f_e = D_e^2 L3_e, epsilon_e = 1 / d_e - 1 / d_{e+1}, Delta_e = d_{e+1} - d_e, q = sum of L_e
// nu_e, l = sum of L3_e nu_e,
//     N   = Omega P - h sum of (rho_e L3_e nu_e + epsilon_e t_e) nu_e^T,
//     S   = I P - sum of (rho_e L_e nu_e + Delta_e t_e) nu_e^T,
//     W_i = sum of (g_i . nu_e) [rho_e^2 L3_e nu nu^T + rho_e epsilon_e (nu t^T + t nu^T) +
//           (L_e - f_e) t t^T],
//     z_i = S g_i - lambda_i q,   c_i = (1 - 2 nu) (lambda_i Omega - h g_i . q),
//     Phi_i = kappa { c_i Id + lambda_i [ (Omega + h sum of rho_e L3_e) n n^T - h^2 (n l^T + l n^T)
//     + N ]
//             - h^3 (g_i . l) n n^T + h [ n (N g_i)^T + (N g_i) n^T - W_i - g_i q^T - q g_i^T ]
//             + (1 - 2 nu) (n z_i^T - z_i n^T) },
//     k   = (kappa / 2) { [(3 - 4 nu) I + h Omega] n - h q }.
// All but n lies in the plane of the face, and is computed there in two coordinates.

#include "coordinates/elastic_columns.h"
#include "coordinates/surface_coordinates.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/somigliana.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/somigliana_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/triangle_integrals-inl.h"

#ifndef CAGEWRIGHT_COORDINATES_SOMIGLIANA_FACES
#define CAGEWRIGHT_COORDINATES_SOMIGLIANA_FACES
namespace cagewright {
namespace {

/// A symmetric matrix: xx, xy, xz, yy, yz, zz.
using SymmetricNumbers = std::array<double, 6>;

/// A face in its own coordinates: the first edge, its outward normal in the plane, and the normal.
struct ElasticFace {
  std::array<Vec3, 3> axes;
  std::array<std::array<double, 2>, 3> along;    ///< t_e
  std::array<std::array<double, 2>, 3> outward;  ///< nu_e
  std::array<std::array<double, 2>, 3> gradient; ///< g_i
  /// Of the axes a, b: a b^T + b a^T, or a a^T: 11, 12, 1n, 22, 2n, nn.
  std::array<SymmetricNumbers, 6> products;
};

struct ElasticCage {
  std::vector<ElasticFace> faces;
  double poisson_ratio = 0.3;
};

ElasticFace make_elastic_face(const Surface::Face& face) {
  ElasticFace elastic;
  elastic.axes = {face.along[0], face.outward[0], face.normal};
  const auto flat = [&](const Vec3& v) -> std::array<double, 2> {
    return {elastic.axes[0].dot(v), elastic.axes[1].dot(v)};
  };
  for (std::size_t e = 0; e < 3; ++e) {
    elastic.along[e] = flat(face.along[e]);
    elastic.outward[e] = flat(face.outward[e]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    elastic.gradient[i] = flat(Vec3(-face.share[i] * face.outward[(i + 1) % 3]));
  }
  std::size_t next = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a; b < 3; ++b) {
      Mat3 product = elastic.axes[a] * elastic.axes[b].transpose();
      if (a != b) {
        product += elastic.axes[b] * elastic.axes[a].transpose();
      }
      elastic.products[next++] = {product(0, 0), product(0, 1), product(0, 2),
                                  product(1, 1), product(1, 2), product(2, 2)};
    }
  }
  return elastic;
}

struct ElasticTile {
  std::span<const Vec3> points;
  OutsideTreatment outside = OutsideTreatment::error;
  double* weights = nullptr;
  std::size_t stride = 16;
};

} // namespace
} // namespace cagewright
#endif

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

/// What a face needs of its edges besides FaceTerms.
template <class V> struct EdgeIntegrals {
  V cube[3];    ///< L3_e
  V epsilon[3]; ///< 1 / d_e - 1 / d_{e+1}
  V delta[3];   ///< d_{e+1} - d_e
};

/// L3 of an edge. Beyond its ends f = tau' / d' - tau / d cancels, and is written otherwise.
template <class V> HWY_INLINE V cube_integral(V square, V tau, V tau_next, V d, V d_next) {
  const V beyond = absolute(V(1.0) / (d * (d + absolute(tau))) -
                            V(1.0) / (d_next * (d_next + absolute(tau_next))));
  const V beside = (tau_next / d_next - tau / d) / larger(square, V(1e-290));
  return select(tau * tau_next > V(0.0), beyond, beside);
}

/// Phi of the three corners: symmetric parts, and the vectors w of skew parts [w]x; and k.
template <class V> struct ElasticTerms {
  V symmetric[3][6];
  V skew[3][3];
  V k[3];
};

/// A sum over the edges of a face.
template <class V>
HWY_INLINE V of_edges(const std::array<double, 3>& factor, const V (&of_edge)[3]) {
  return fma(V(factor[0]), of_edge[0], fma(V(factor[1]), of_edge[1], V(factor[2]) * of_edge[2]));
}

template <class V>
HWY_INLINE ElasticTerms<V> elastic_terms(const Surface::Face& plain, const ElasticFace& face,
                                         const FaceTerms<V>& f, const EdgeIntegrals<V>& edges,
                                         double poisson_ratio) {
  constexpr double pi = full_angle / 4;
  const double kappa = 1 / (8 * pi * (1 - poisson_ratio));
  const double loose = 1 - 2 * poisson_ratio;
  const V h = f.height;
  const V potential = f.potential();
  V q[2] = {V(0.0), V(0.0)};
  V l[2] = {V(0.0), V(0.0)};
  V n11 = f.omega;
  V n12(0.0);
  V n22 = f.omega;
  V s11 = potential;
  V s12(0.0);
  V s22 = potential;
  V normal_sum(0.0);
  for (std::size_t e = 0; e < 3; ++e) {
    const auto& nu = face.outward[e];
    const auto& t = face.along[e];
    q[0] = fma(f.log[e], V(nu[0]), q[0]);
    q[1] = fma(f.log[e], V(nu[1]), q[1]);
    l[0] = fma(edges.cube[e], V(nu[0]), l[0]);
    l[1] = fma(edges.cube[e], V(nu[1]), l[1]);
    const V rho_cube = f.rho[e] * edges.cube[e];
    normal_sum += rho_cube;
    const V across = h * rho_cube;
    const V along = h * edges.epsilon[e];
    n11 -= fma(across, V(nu[0] * nu[0]), along * V(t[0] * nu[0]));
    n12 -= fma(across, V(nu[0] * nu[1]), along * V(0.5 * (t[0] * nu[1] + t[1] * nu[0])));
    n22 -= fma(across, V(nu[1] * nu[1]), along * V(t[1] * nu[1]));
    const V rho_log = f.rho[e] * f.log[e];
    s11 -= fma(rho_log, V(nu[0] * nu[0]), edges.delta[e] * V(t[0] * nu[0]));
    s12 -= fma(rho_log, V(nu[0] * nu[1]), edges.delta[e] * V(0.5 * (t[0] * nu[1] + t[1] * nu[0])));
    s22 -= fma(rho_log, V(nu[1] * nu[1]), edges.delta[e] * V(t[1] * nu[1]));
  }
  const V normal_part = fma(h, normal_sum, f.omega);
  const V h2 = h * h;
  // W_i without (g_i . nu_e), the same for all corners.
  V m11[3];
  V m12[3];
  V m22[3];
  for (std::size_t e = 0; e < 3; ++e) {
    const auto& nu = face.outward[e];
    const auto& t = face.along[e];
    const V rho2 = f.rho[e] * f.rho[e];
    const V nunu = rho2 * edges.cube[e];
    const V nut = f.rho[e] * edges.epsilon[e];
    const V tt = f.log[e] - edges.cube[e] * (rho2 + h2);
    m11[e] = fma(nunu, V(nu[0] * nu[0]), fma(nut, V(2 * nu[0] * t[0]), tt * V(t[0] * t[0])));
    m12[e] =
        fma(nunu, V(nu[0] * nu[1]), fma(nut, V(nu[0] * t[1] + nu[1] * t[0]), tt * V(t[0] * t[1])));
    m22[e] = fma(nunu, V(nu[1] * nu[1]), fma(nut, V(2 * nu[1] * t[1]), tt * V(t[1] * t[1])));
  }
  ElasticTerms<V> terms;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& g = face.gradient[i];
    const V lambda = f.lambda[i];
    const V w11 = of_edges(plain.slope[i], m11);
    const V w12 = of_edges(plain.slope[i], m12);
    const V w22 = of_edges(plain.slope[i], m22);
    const V gq = fma(V(g[0]), q[0], V(g[1]) * q[1]);
    const V gl = fma(V(g[0]), l[0], V(g[1]) * l[1]);
    const V c = V(loose) * (lambda * f.omega - h * gq);
    const V ng1 = fma(n11, V(g[0]), n12 * V(g[1]));
    const V ng2 = fma(n12, V(g[0]), n22 * V(g[1]));
    const V local[6] = {
        fma(lambda, n11, c) - h * (w11 + V(2 * g[0]) * q[0]),
        lambda * n12 - h * (w12 + fma(V(g[0]), q[1], V(g[1]) * q[0])),
        h * ng1 - lambda * h2 * l[0],
        fma(lambda, n22, c) - h * (w22 + V(2 * g[1]) * q[1]),
        h * ng2 - lambda * h2 * l[1],
        fma(lambda, normal_part, c) - h2 * h * gl,
    };
    for (std::size_t k = 0; k < 6; ++k) {
      V sum = local[0] * V(kappa * face.products[0][k]);
      for (std::size_t m = 1; m < 6; ++m) {
        sum = fma(local[m], V(kappa * face.products[m][k]), sum);
      }
      terms.symmetric[i][k] = sum;
    }
    // n z^T - z n^T = [z x n]x; e1 x n = e2... of t, nu = t x n, n: t x n = nu, nu x n = -t.
    const V z1 = fma(s11, V(g[0]), s12 * V(g[1])) - lambda * q[0];
    const V z2 = fma(s12, V(g[0]), s22 * V(g[1])) - lambda * q[1];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      terms.skew[i][k] = fma(z1, V(kappa * loose * face.axes[1][axis]),
                             -(z2 * V(kappa * loose * face.axes[0][axis])));
    }
  }
  const V across = fma(V(3 - 4 * poisson_ratio), potential, h * f.omega);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const V along = fma(q[0], V(face.axes[0][axis]), q[1] * V(face.axes[1][axis]));
    terms.k[k] = V(kappa / 2) * fma(across, V(face.axes[2][axis]), -(h * along));
  }
  return terms;
}

/// Phi of a vertex from the sums of symmetric and skew parts.
template <class V> HWY_INLINE void matrix_of(const V (&s)[6], const V (&w)[3], V (&phi)[9]) {
  phi[0] = s[0];
  phi[1] = s[1] - w[2];
  phi[2] = s[2] + w[1];
  phi[3] = s[1] + w[2];
  phi[4] = s[3];
  phi[5] = s[4] - w[0];
  phi[6] = s[2] - w[1];
  phi[7] = s[4] + w[0];
  phi[8] = s[5];
}

constexpr std::size_t parts = 9; // of a vertex: 6 symmetric, 3 skew

/// The sums of a point that is near the cage, on it or outside: parts for each vertex and middle,
/// and k for each face.
struct OnePoint {
  std::vector<double> sums;
  std::vector<double> k;

  void add(const Surface::Face& face, const ElasticTerms<double>& terms, double factor) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t p = 0; p < 6; ++p) {
        sums[parts * face.vertices[i] + p] += factor * terms.symmetric[i][p];
      }
      for (std::size_t p = 0; p < 3; ++p) {
        sums[parts * face.vertices[i] + 6 + p] += factor * terms.skew[i][p];
      }
    }
  }
};

EdgeIntegrals<double> edge_integrals(const Surface& surface, const PointTerms& point,
                                     std::size_t f) {
  EdgeIntegrals<double> edges;
  const Surface::Face& face = surface.faces[f];
  for (std::size_t e = 0; e < 3; ++e) {
    const Surface::Edge& edge = surface.edges[face.edges[e]];
    const PointTerms::EdgeTerms& terms = point.edge(face.edges[e]);
    const double d = point.distance(face.vertices[e]);
    const double d_next = point.distance(face.vertices[(e + 1) % 3]);
    constexpr double on_edge = 1e-14;
    const bool is_on = terms.is_between() && terms.square < on_edge * on_edge;
    edges.cube[e] = is_on ? 0
                          : cube_integral(terms.square, terms.tau, terms.tau_next,
                                          point.distance(edge.from), point.distance(edge.to));
    // At a vertex the integral along the other edges there has no value, and no part in any sum.
    const double inverse = d > 1e-14 ? 1 / d : 0;
    const double inverse_next = d_next > 1e-14 ? 1 / d_next : 0;
    edges.epsilon[e] = inverse - inverse_next;
    edges.delta[e] = d_next - d;
    edges.cube[e] = std::isfinite(edges.cube[e]) ? edges.cube[e] : 0;
  }
  return edges;
}

void put(const Surface& surface, const ElasticTile& tile, std::size_t i, OnePoint& one,
         bool is_defined) {
  const std::size_t vertices = surface.positions.size();
  double* const to = tile.weights + i;
  for (std::size_t c = 0; c < vertices; ++c) {
    double symmetric[6];
    double skew[3];
    double phi[9];
    std::copy_n(&one.sums[parts * c], 6, symmetric);
    std::copy_n(&one.sums[parts * c + 6], 3, skew);
    matrix_of(symmetric, skew, phi);
    for (std::size_t p = 0; p < 9; ++p) {
      to[(9 * c + p) * tile.stride] = phi[p];
    }
  }
  const double unit = surface.frame.scaled_diagonal();
  for (std::size_t k = 0; k < one.k.size(); ++k) {
    to[(9 * vertices + k) * tile.stride] = one.k[k] / unit;
  }
  const std::size_t place = 9 * vertices + one.k.size();
  for (std::size_t a = 0; a < 3; ++a) {
    to[(place + a) * tile.stride] =
        is_defined ? tile.points[i][static_cast<Eigen::Index>(a)] / unit : 0;
  }
  to[(place + 3) * tile.stride] = is_defined ? 1 : 0;
}

/// On the cage: what the solid angles of the faces touched stand for.
void add_on_surface(const Surface& surface, const ElasticCage& cage, const PointTerms& point,
                    const PointPlace& place, OnePoint& one) {
  std::array<double, parts> missing = {1, 0, 0, 1, 0, 1, 0, 0, 0}; // the identity, less the sum
  for (std::size_t v = 0; v < surface.positions.size(); ++v) {
    for (std::size_t p = 0; p < parts; ++p) {
      missing[p] -= one.sums[parts * v + p];
    }
  }
  for (const auto& [vertex, hat] : place.hats) {
    for (std::size_t p = 0; p < parts; ++p) {
      one.sums[parts * vertex + p] += hat * missing[p];
    }
  }
  // n (S g)^T - (S g) n^T of the faces touched: their sum over the corners is 0.
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    if (!point.touches(f)) {
      continue;
    }
    FaceTerms<double> terms = point.face(f);
    terms.height = 0;
    terms.omega = 0;
    EdgeIntegrals<double> edges = edge_integrals(surface, point, f);
    for (std::size_t e = 0; e < 3; ++e) {
      edges.cube[e] = 0;
      edges.epsilon[e] = 0;
    }
    // z = S g alone: without lambda q.
    terms.lambda[0] = terms.lambda[1] = terms.lambda[2] = 0;
    ElasticTerms<double> skew =
        elastic_terms(surface.faces[f], cage.faces[f], terms, edges, cage.poisson_ratio);
    for (auto& symmetric : skew.symmetric) {
      std::fill_n(symmetric, 6, 0.0);
    }
    one.add(surface.faces[f], skew, 1);
  }
}

void solve_one(const Surface& surface, const ElasticCage& cage, const ElasticTile& tile,
               std::size_t i, TileReport& report) {
  OnePoint one{std::vector<double>(parts * surface.positions.size(), 0.0),
               std::vector<double>(3 * surface.faces.size(), 0.0)};
  const auto bit = static_cast<std::uint16_t>(1U << i);
  const Vec3& x = tile.points[i];
  if (!is_usable(x)) {
    report.undefined |= bit;
    put(surface, tile, i, one, false);
    return;
  }
  const PointTerms point(surface, x);
  const PointPlace place = place_of(surface, point);
  if (place.outside) {
    report.outside |= bit;
    if (tile.outside != OutsideTreatment::continuation) {
      put(surface, tile, i, one, false);
      return;
    }
  }
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const ElasticTerms<double> terms =
        elastic_terms(surface.faces[f], cage.faces[f], point.face(f),
                      edge_integrals(surface, point, f), cage.poisson_ratio);
    std::copy_n(terms.k, 3, &one.k[3 * f]);
    if (!(place.on_surface && point.touches(f))) {
      one.add(surface.faces[f], terms, 1);
    }
  }
  if (place.on_surface) {
    report.on_surface |= bit;
    add_on_surface(surface, cage, point, place, one);
  } else if (place.outside) {
    for (const auto& [f, share] : place.through) {
      FaceTerms<double> jump{};
      jump.height = point.face(f).height;
      std::copy_n(point.face(f).lambda, 3, jump.lambda);
      jump.omega = full_angle;
      const ElasticTerms<double> terms = elastic_terms(surface.faces[f], cage.faces[f], jump,
                                                       EdgeIntegrals<double>{}, cage.poisson_ratio);
      const double turns = share * (1 - place.winding);
      one.add(surface.faces[f], terms, turns);
      for (std::size_t k = 0; k < 3; ++k) {
        one.k[3 * f + k] += turns * terms.k[k];
      }
    }
  } else if (place.winding > 1) {
    for (std::vector<double>* all : {&one.sums, &one.k}) {
      for (double& w : *all) {
        w /= place.winding;
      }
    }
  }
  put(surface, tile, i, one, true);
}

TileReport somigliana_tile(const Surface& surface, const ElasticCage& cage,
                           const ElasticTile& tile) {
  const std::size_t vertices = surface.positions.size();
  const SixteenPoints all(tile.points);
  const std::size_t own = LanePoints::scratch_size(surface);
  AlignedBuffer<double> scratch(own + (surface.edges.size() + parts * vertices) * lanes);
  double* const cubes = scratch.data() + own;
  double* const sums = cubes + surface.edges.size() * lanes;
  const Lanes per_unit(1 / surface.frame.scaled_diagonal());
  std::array<bool, 16> again{};
  for (std::size_t first = 0; first < 16; first += lanes) {
    const Lanes x = Lanes::load(&all.x[first]);
    const Lanes y = Lanes::load(&all.y[first]);
    const Lanes z = Lanes::load(&all.z[first]);
    LanePoints points(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
    for (std::size_t i = 0; i < surface.edges.size(); ++i) {
      const Surface::Edge& edge = surface.edges[i];
      const Vec3& from = surface.positions[edge.from];
      const Lanes ax = Lanes(from.x()) - x;
      const Lanes ay = Lanes(from.y()) - y;
      const Lanes az = Lanes(from.z()) - z;
      const Lanes tau = fma(ax, Lanes(edge.along.x()),
                            fma(ay, Lanes(edge.along.y()), az * Lanes(edge.along.z())));
      const Lanes px = ax - tau * Lanes(edge.along.x());
      const Lanes py = ay - tau * Lanes(edge.along.y());
      const Lanes pz = az - tau * Lanes(edge.along.z());
      const Lanes square = fma(px, px, fma(py, py, pz * pz));
      cube_integral(square, tau, tau + Lanes(edge.length), points.distance(edge.from),
                    points.distance(edge.to))
          .store(cubes + i * lanes);
    }
    std::fill_n(sums, parts * vertices * lanes, 0.0);
    double* const out = tile.weights + first;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const Surface::Face& face = surface.faces[f];
      const FaceTerms<Lanes> terms = points.face(f);
      EdgeIntegrals<Lanes> edges;
      Lanes inverse[3];
      for (std::size_t e = 0; e < 3; ++e) {
        inverse[e] = Lanes(1.0) / terms.distance[e];
      }
      for (std::size_t e = 0; e < 3; ++e) {
        edges.cube[e] = Lanes::load(cubes + face.edges[e] * lanes);
        edges.epsilon[e] = inverse[e] - inverse[(e + 1) % 3];
        edges.delta[e] = terms.distance[(e + 1) % 3] - terms.distance[e];
      }
      const ElasticTerms<Lanes> elastic =
          elastic_terms(face, cage.faces[f], terms, edges, cage.poisson_ratio);
      for (std::size_t i = 0; i < 3; ++i) {
        double* const to = sums + parts * face.vertices[i] * lanes;
        for (std::size_t p = 0; p < 6; ++p) {
          (Lanes::load(to + p * lanes) + elastic.symmetric[i][p]).store(to + p * lanes);
        }
        for (std::size_t p = 0; p < 3; ++p) {
          (Lanes::load(to + (6 + p) * lanes) + elastic.skew[i][p]).store(to + (6 + p) * lanes);
        }
      }
      for (std::size_t k = 0; k < 3; ++k) {
        (elastic.k[k] * per_unit).store_unaligned(out + (9 * vertices + 3 * f + k) * tile.stride);
      }
    }
    for (std::size_t c = 0; c < vertices; ++c) {
      Lanes symmetric[6];
      Lanes skew[3];
      Lanes phi[9];
      for (std::size_t p = 0; p < 6; ++p) {
        symmetric[p] = Lanes::load(sums + (parts * c + p) * lanes);
      }
      for (std::size_t p = 0; p < 3; ++p) {
        skew[p] = Lanes::load(sums + (parts * c + 6 + p) * lanes);
      }
      matrix_of(symmetric, skew, phi);
      for (std::size_t p = 0; p < 9; ++p) {
        phi[p].store_unaligned(out + (9 * c + p) * tile.stride);
      }
    }
    const std::size_t place = 9 * vertices + 3 * surface.faces.size();
    (x * per_unit).store_unaligned(out + place * tile.stride);
    (y * per_unit).store_unaligned(out + (place + 1) * tile.stride);
    (z * per_unit).store_unaligned(out + (place + 2) * tile.stride);
    Lanes(1.0).store_unaligned(out + (place + 3) * tile.stride);
    const LaneFlags flagged = points.flagged();
    for (std::size_t i = 0; i < lanes; ++i) {
      again[first + i] = flagged[i];
    }
  }
  TileReport report;
  for (std::size_t i = 0; i < tile.points.size(); ++i) {
    if (again[i]) {
      solve_one(surface, cage, tile, i, report);
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

HWY_EXPORT(somigliana_tile);

namespace {

class SomiglianaCoordinates : public SurfaceCoordinates {
public:
  SomiglianaCoordinates(std::shared_ptr<const ColumnRule> rule, Surface surface,
                        const SomiglianaOptions& options)
      : SurfaceCoordinates(std::move(rule), std::move(surface), options.outside) {
    elastic_.poisson_ratio = options.poisson_ratio;
    for (const Surface::Face& face : this->surface().faces) {
      elastic_.faces.push_back(make_elastic_face(face));
    }
  }

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return HWY_DYNAMIC_DISPATCH(somigliana_tile)(surface(), elastic_,
                                                 {points, outside(), weights, stride});
  }

  ElasticCage elastic_;
};

constinit const CoordinateOption poisson_ratio_option = {
    .name = "poisson-ratio",
    .help =
        "How much the body narrows where it is stretched: at 0 not, near 0.5 so that its volume "
        "stays",
    .initial = 0.3,
    .least = 0,
    .most = 0.499};
constinit const CoordinateOption bulge_option = {
    .name = "bulge",
    .help = "How much convex bends swell, and concave ones are drawn in",
    .initial = 0,
    .least = 0,
    .most = 10,
    .while_posing = true};
constinit const CoordinateOption local_option = {
    .name = "local",
    .help = "How far turns and stretches are those of each face: at 0 those of the cage as a whole",
    .initial = 0,
    .least = 0,
    .most = 1,
    .while_posing = true};

constexpr std::array<const CoordinateOption*, 5> kind_options = {
    &quads_option, &outside_option, &poisson_ratio_option, &bulge_option, &local_option};

SomiglianaOptions options_of(const CoordinateSettings& settings) {
  return {.quads = static_cast<QuadTreatment>(settings.choice(quads_option)),
          .outside = static_cast<OutsideTreatment>(settings.choice(outside_option)),
          .poisson_ratio = settings.number(poisson_ratio_option),
          .bulge = settings.number(bulge_option),
          .local = settings.number(local_option)};
}

Result<std::shared_ptr<const Coordinates>>
prepare_kind(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  return somigliana_coordinates(cage, options_of(settings));
}

Result<std::shared_ptr<const ColumnRule>> kind_rule(const PolygonMesh& cage,
                                                    const CoordinateSettings& settings) {
  const SomiglianaOptions options = options_of(settings);
  const Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  return elastic_columns(cage.positions, *surface, options);
}

} // namespace

Result<std::shared_ptr<const Coordinates>>
somigliana_coordinates(const PolygonMesh& cage, const SomiglianaOptions& options) {
  if (!(options.poisson_ratio >= 0 && options.poisson_ratio < 0.5) || !(options.bulge >= 0) ||
      !(options.local >= 0 && options.local <= 1)) {
    return Error{ErrorCode::invalid_option, "somigliana coordinates need a Poisson ratio of 0 to "
                                            "0.499, a bulge of 0 or more and 0 to 1 local"};
  }
  Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  auto rule = elastic_columns(cage.positions, *surface, options);
  return std::shared_ptr<const Coordinates>(
      std::make_shared<SomiglianaCoordinates>(std::move(rule), *std::move(surface), options));
}

constinit const CoordinateKind somigliana_kind = {
    .name = "somigliana",
    .idea = "the model as an elastic body of which the cage is the surface: it swells and narrows",
    .quads = "center or diagonal",
    .sign = "matrices and tractions",
    .reproduces = "similarities",
    .on_cage = "does not interpolate",
    .outside = "refused, at rest, or continued",
    .locality = "global",
    .made_by = "closed form",
    .cost = "29 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = kind_rule,
};

} // namespace cagewright
#endif
