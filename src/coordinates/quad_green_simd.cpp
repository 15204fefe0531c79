// Green coordinates with bilinear quads. Compiled once for each instruction set (Highway includes
// this file again and again); the best is chosen when the program runs.
//
//     phi_k = the integral of B_k (P - x) . N / 4 pi r^3 du dv,   psi_k = that of B_k / 4 pi r.
//
// What Gauss's rule leaves is mended: the sum of phi_k and that of phi_k (p_k - x) + psi_k N_k hang
// on the rim of the patch alone, and are known in closed form from two triangles that have the same
// rim; between the two the former differs by 1.

#include "coordinates/patch_columns.h"
#include "coordinates/patches.h"
#include "coordinates/surface_coordinates.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/quad_green.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/quad_green_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/patch_quadrature-inl.h"
#include "coordinates/triangle_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

constexpr double per_angle = 1 / full_angle;
/// Nearer than this to the cage, in diagonals, coordinates are those so far inside.
constexpr double at_patch = 1e-9;

/// The weights of a patch, in the frame.
struct PatchWeights {
  std::array<double, 4> phi{};
  std::array<double, 4> psi{};
};

/// The least change after which the sum of phi grows by `sum`, and that of phi_k (p_k - x) + psi_k
/// N_k by `vector`.
void add_least(const CagePatch& patch, const Vec3& x, double sum, const Vec3& vector,
               PatchWeights& weights) {
  const Vec3 rest = vector - sum * (patch.least.middle - x);
  for (std::size_t k = 0; k < 8; ++k) {
    const std::array<double, 4>& f = patch.least.factor[k];
    (k < 4 ? weights.phi[k] : weights.psi[k - 4]) +=
        f[0] * sum + f[1] * rest.x() + f[2] * rest.y() + f[3] * rest.z();
  }
}

/// (P - x) . N / r^3 and 1 / r.
struct GreenKernel {
  HWY_INLINE static void put(Lanes along, Lanes inverse, Lanes (&values)[2]) {
    values[0] = along * inverse * inverse * inverse;
    values[1] = inverse;
  }
  HWY_INLINE void operator()(const Lanes (&square)[1], const Lanes (&along)[1],
                             Lanes (&values)[1][2]) const {
    put(along[0], Lanes(1.0) / root(square[0]), values[0]);
  }
  HWY_INLINE void operator()(const Lanes (&square)[2], const Lanes (&along)[2],
                             Lanes (&values)[2][2]) const {
    const Lanes first = root(square[0]);
    const Lanes second = root(square[1]);
    const Lanes inverse = Lanes(1.0) / (first * second);
    put(along[0], inverse * second, values[0]);
    put(along[1], inverse * first, values[1]);
  }
};

using Integrals = PatchIntegrals<2>;

void integrate(const CagePatch& patch, std::span<const Vec3> points, std::uint32_t wanted,
               Integrals& integrals) {
  integrals.run(patch.patch, points, wanted, GreenKernel());
}

/// A patch that the point lies on.
struct Touched {
  Vec3 normal;
  std::size_t patch = 0;
};

/// All that is known of one point.
struct Solution {
  std::vector<double> phi; ///< of vertices
  std::vector<double> psi; ///< of triangles
  std::vector<PatchWeights> patches;
  double winding = 0;
  bool on_triangle = false;
};

/// \param touched  takes the patches that the point lies on; only if there are none is the result
/// of
///                 use
Solution solve_off(const PatchedSurface& cage, const PointTerms& point, const Vec3& x,
                   Integrals& integrals, std::vector<Touched>& touched) {
  const Surface& surface = cage.surface;
  Solution solution;
  solution.phi.assign(surface.positions.size(), 0.0);
  const auto add_face = [&](std::size_t f, auto&& take_phi, double& sum, Vec3& vector) {
    const Surface::Face& face = surface.faces[f];
    const FaceTerms<double>& terms = point.face(f);
    for (std::size_t k = 0; k < 3; ++k) {
      const double phi =
          per_angle * (terms.lambda[k] * terms.omega - terms.height * terms.slope(face, k));
      take_phi(face.vertices[k], phi);
      vector += phi * point.to_vertex(face.vertices[k]);
    }
    const double psi = per_angle * terms.potential();
    vector += psi * face.normal;
    sum += per_angle * terms.omega;
    return psi;
  };
  std::size_t on = 0;
  for (std::size_t t = 0; t < cage.triangles.size(); ++t) {
    const std::size_t f = cage.triangles[t];
    Vec3 vector = Vec3::Zero();
    const bool is_on = point.touches(f);
    double sum = 0;
    solution.psi.push_back(add_face(
        f, [&](Index v, double phi) { solution.phi[v] += is_on ? 0 : phi; }, sum, vector));
    solution.winding += is_on ? 0 : sum;
    if (is_on) { // hats stand for its solid angle, see below
      solution.on_triangle = true;
      on = f;
    }
  }
  for (std::size_t q = 0; q < cage.patches.size(); ++q) {
    const Patch& patch = cage.patches[q].patch;
    PatchWeights& own = solution.patches.emplace_back();
    integrate(cage.patches[q], std::span(&x, 1), 1, integrals);
    if (integrals.touched() != 0) {
      const PatchPlace place = integrals.place(patch, x, 0);
      const Vec3 normal = patch.normal[0] + place.u * patch.normal[1] + place.v * patch.normal[2];
      touched.push_back({normal.normalized(), q});
      continue;
    }
    own.phi = integrals.with_hats(0, 0);
    own.psi = integrals.with_hats(1, 0);
    double sum = 0;
    Vec3 vector = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      own.phi[k] *= per_angle;
      own.psi[k] *= per_angle;
    }
    for (std::size_t k = 0; k < cage.patches[q].triangle_count; ++k) {
      (void)add_face(
          cage.patches[q].triangles[k], [](Index, double) {}, sum, vector);
    }
    double found = 0;
    for (const double phi : own.phi) {
      found += phi;
    }
    const double between = std::round(found - sum); // the patch and the triangles
    sum += between;
    solution.winding += sum;
    for (std::size_t k = 0; k < 4; ++k) {
      sum -= own.phi[k];
      vector -= own.phi[k] * (patch.corners[k] - x) + own.psi[k] * patch.normals[k];
    }
    add_least(cage.patches[q], x, sum, vector, own);
  }
  if (solution.on_triangle) { // the limit from inside
    const std::array<double, 3> hats = hats_on(point, on);
    for (std::size_t k = 0; k < 3; ++k) {
      solution.phi[surface.faces[on].vertices[k]] += hats[k] * (1 - solution.winding);
    }
    solution.winding = 1;
  }
  return solution;
}

/// The nearest place of a patch, and how far off it is.
struct NearestOnPatch {
  double u = 0, v = 0, distance = 0;
};

NearestOnPatch nearest_on(const Patch& patch, const Vec3& x) {
  const std::array<Vec3, 4>& c = patch.position;
  const auto off = [&](double u, double v) {
    return Vec3((c[0] - x) + u * c[1] + v * c[2] + u * v * c[3]);
  };
  NearestOnPatch nearest{0, 0, off(0, 0).norm()};
  constexpr int steps = 8;
  for (int i = 0; i <= steps; ++i) {
    for (int k = 0; k <= steps; ++k) {
      const double u = i / static_cast<double>(steps);
      const double v = k / static_cast<double>(steps);
      const double distance = off(u, v).norm();
      nearest = distance < nearest.distance ? NearestOnPatch{u, v, distance} : nearest;
    }
  }
  // One coordinate after the other, each exactly: the distance falls with every step.
  for (int step = 0; step < 60; ++step) {
    const Vec3 along_u = c[1] + nearest.v * c[3];
    const double more_u = -off(nearest.u, nearest.v).dot(along_u) / along_u.squaredNorm();
    nearest.u = std::clamp(nearest.u + (std::isfinite(more_u) ? more_u : 0), 0.0, 1.0);
    const Vec3 along_v = c[2] + nearest.u * c[3];
    const double more_v = -off(nearest.u, nearest.v).dot(along_v) / along_v.squaredNorm();
    nearest.v = std::clamp(nearest.v + (std::isfinite(more_v) ? more_v : 0), 0.0, 1.0);
  }
  nearest.distance = off(nearest.u, nearest.v).norm();
  return nearest;
}

/// Outside: the formulas go on through the nearest faces, as those of triangles do.
void continue_outside(const PatchedSurface& cage, const PointTerms& point, const Vec3& x,
                      Solution& solution) {
  const double turns = 1 - std::round(solution.winding);
  std::vector<double> distances;
  std::vector<NearestOnPatch> places;
  for (const std::size_t f : cage.triangles) {
    distances.push_back(point.face_distance(f));
  }
  for (const CagePatch& patch : cage.patches) {
    places.push_back(nearest_on(patch.patch, x));
    distances.push_back(places.back().distance);
  }
  const double reach = 1.5 * *std::min_element(distances.begin(), distances.end());
  double all = 0;
  for (double& d : distances) {
    d = d < reach ? (reach - d) * (reach - d) : 0; // from here on: shares
    all += d;
  }
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double share = turns * distances[i] / all;
    if (share == 0) {
      continue;
    }
    if (i < cage.triangles.size()) {
      const std::size_t f = cage.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        solution.phi[cage.surface.faces[f].vertices[k]] += share * point.face(f).lambda[k];
      }
      solution.psi[i] -= share * point.face(f).height;
      continue;
    }
    const std::size_t q = i - cage.triangles.size();
    const Patch& patch = cage.patches[q].patch;
    const std::array<double, 4> hats = hats_at(places[q].u, places[q].v);
    Vec3 to_place = -x;
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      to_place += hats[k] * patch.corners[k];
      normal += hats[k] * patch.normals[k];
    }
    // x = P + c N, and at the rim besides what neither has.
    const double along = normal.norm() > 0 ? -to_place.dot(normal) / normal.squaredNorm() : 0;
    PatchWeights more;
    for (std::size_t k = 0; k < 4; ++k) {
      more.phi[k] = hats[k];
      more.psi[k] = along * hats[k];
    }
    add_least(cage.patches[q], x, 0, -(to_place + along * normal), more);
    for (std::size_t k = 0; k < 4; ++k) {
      solution.patches[q].phi[k] += share * more.phi[k];
      solution.patches[q].psi[k] += share * more.psi[k];
    }
  }
}

void scale(Solution& solution, double factor) {
  for (double& w : solution.phi) {
    w *= factor;
  }
  for (double& w : solution.psi) {
    w *= factor;
  }
  for (PatchWeights& own : solution.patches) {
    for (std::size_t k = 0; k < 4; ++k) {
      own.phi[k] *= factor;
      own.psi[k] *= factor;
    }
  }
}

/// \returns nothing where the point has no weights; the report says why
std::optional<Solution> solve_one(const PatchedSurface& cage, const Vec3& given,
                                  Integrals& integrals, OutsideTreatment outside, std::uint16_t bit,
                                  TileReport& report) {
  Vec3 x = given;
  std::vector<Touched> touched;
  std::optional<PointTerms> point(std::in_place, cage.surface, x);
  Solution solution = solve_off(cage, *point, x, integrals, touched);
  Vec3 normal = Vec3::Zero();
  for (const Touched& one : touched) {
    normal += one.normal;
  }
  if (!touched.empty() || solution.on_triangle) {
    report.on_surface |= bit;
  }
  if (!touched.empty()) {
    normal = normal.norm() > 1e-3 ? normal : touched.front().normal;
    // Far enough from all of them, however they meet.
    double least = 1;
    for (const Touched& one : touched) {
      least = std::min(least, one.normal.dot(normal.normalized()));
    }
    const double step = 1.5 * at_patch * cage.surface.frame.scaled_diagonal();
    x -= step / std::max(least, 0.05) * normal.normalized();
    std::vector<Touched> again;
    point.emplace(cage.surface, x);
    solution = solve_off(cage, *point, x, integrals, again);
    if (!again.empty()) { // in a corner narrower than that
      report.undefined |= bit;
      return std::nullopt;
    }
  }
  const double winding = std::round(solution.winding);
  if (winding <= 0) {
    if (touched.empty()) {
      report.outside |= bit;
      if (outside != OutsideTreatment::continuation) {
        return std::nullopt;
      }
    }
    continue_outside(cage, *point, x, solution);
  } else if (winding > 1) {
    scale(solution, 1 / winding);
  }
  if (!touched.empty()) { // they shall give the point itself
    const std::size_t patch = touched.front().patch;
    add_least(cage.patches[patch], x, 0, given - x, solution.patches[patch]);
  }
  return solution;
}

/// All points of a tile side by side: those of which it cannot be told whether they are inside, and
/// those near edges, are left to solve_one().
struct Tile {
  const PatchedSurface& cage;
  std::span<const Vec3> points;
  const WeightsOfTile& out;
  SixteenPoints all;
  AlignedBuffer<double> phi;     ///< of vertices: sixteen each
  AlignedBuffer<double> rims;    ///< L_e times a x t, coordinate after coordinate
  AlignedBuffer<double> lengths; ///< from the points to vertices
  Integrals& integrals;
  std::uint32_t near = 0; ///< one bit for each point
  std::array<Lanes, 16 / lanes> winding;

  Tile(const PatchedSurface& patched, std::span<const Vec3> given, Integrals& own,
       const WeightsOfTile& to)
      : cage(patched), points(given), out(to), all(given), phi(16 * vertex_count()),
        rims(48 * patched.rims.size()), lengths(16 * vertex_count()), integrals(own) {
    std::fill_n(phi.data(), 16 * vertex_count(), 0.0);
    winding.fill(Lanes(0.0));
    add_triangles();
    make_rims();
  }

  [[nodiscard]] std::size_t vertex_count() const { return cage.surface.positions.size(); }
  [[nodiscard]] HWY_INLINE LaneVector to_vertex(Index vertex, std::size_t first) const {
    return LaneVector(cage.surface.positions[vertex]) - LaneVector(Lanes::load(&all.x[first]),
                                                                   Lanes::load(&all.y[first]),
                                                                   Lanes::load(&all.z[first]));
  }
  HWY_INLINE void add(Index vertex, std::size_t first, Lanes what) {
    double* const to = phi.data() + 16 * vertex + first;
    (Lanes::load(to) + what).store(to);
  }
  [[nodiscard]] HWY_INLINE double* column(std::size_t index, std::size_t first) const {
    return out.weights + (vertex_count() + index) * out.stride + first;
  }
  void flag(const LaneFlags& flags, std::size_t first) {
    for (std::size_t k = 0; k < lanes; ++k) {
      near |= flags[k] ? 1U << (first + k) : 0U;
    }
  }

  void add_triangles() {
    const Surface& surface = cage.without_quads;
    if (surface.faces.empty()) {
      return;
    }
    const Lanes per_unit(1 / surface.frame.scaled_diagonal());
    AlignedBuffer<double> scratch(LanePoints::scratch_size(surface));
    for (std::size_t first = 0; first < 16; first += lanes) {
      LanePoints lane_points(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
      for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const Surface::Face& face = surface.faces[f];
        const FaceTerms<Lanes> terms = lane_points.face(f);
        for (std::size_t k = 0; k < 3; ++k) {
          add(face.vertices[k], first,
              Lanes(per_angle) *
                  fma(terms.lambda[k], terms.omega, -(terms.height * terms.slope(face, k))));
        }
        (Lanes(per_angle) * per_unit * terms.potential()).store_unaligned(column(f, first));
        winding[first / lanes] += Lanes(per_angle) * terms.omega;
      }
      flag(lane_points.near(), first);
    }
  }

  void make_rims() {
    for (std::size_t first = 0; first < 16; first += lanes) {
      Lanes nearest(1e300);
      for (std::size_t v = 0; v < vertex_count(); ++v) {
        const LaneVector a = to_vertex(static_cast<Index>(v), first);
        const Lanes d = root(dot(a, a));
        nearest = smaller(nearest, d);
        d.store(lengths.data() + 16 * v + first);
      }
      Mask flagged = nearest < Lanes(near_edge);
      for (std::size_t e = 0; e < cage.rims.size(); ++e) {
        const RimEdge& edge = cage.rims[e];
        const Lanes sum = Lanes::load(lengths.data() + 16 * edge.from + first) +
                          Lanes::load(lengths.data() + 16 * edge.to + first);
        const Lanes gap = sum - Lanes(edge.length); // at least 2 D^2 / length
        flagged = flagged | (gap * Lanes(edge.length) < Lanes(2 * near_edge * near_edge));
        const Lanes log = logarithm((sum + Lanes(edge.length)) / larger(gap, Lanes(1e-30)));
        const LaneVector vector = log * cross(to_vertex(edge.from, first), LaneVector(edge.along));
        vector.x.store(rims.data() + 48 * e + first);
        vector.y.store(rims.data() + 48 * e + 16 + first);
        vector.z.store(rims.data() + 48 * e + 32 + first);
      }
      flag(LaneFlags(flagged), first);
    }
  }

  /// The solid angle of the two triangles, in full angles, but for whole ones.
  [[nodiscard]] HWY_INLINE Lanes solid_angle(const CagePatch& patch, std::size_t first) {
    Lanes real(1.0);
    Lanes imaginary(0.0);
    for (std::size_t t = 0; t < patch.triangle_count; ++t) {
      const std::array<Index, 3>& v = cage.surface.faces[patch.triangles[t]].vertices;
      LaneVector a[3];
      Lanes d[3];
      for (std::size_t k = 0; k < 3; ++k) {
        a[k] = to_vertex(v[k], first);
        d[k] = Lanes::load(lengths.data() + 16 * v[k] + first);
      }
      const Lanes above = dot(a[0], cross(a[1], a[2]));
      const Lanes below =
          fma(dot(a[0], a[1]), d[2],
              fma(dot(a[1], a[2]), d[0], fma(dot(a[2], a[0]), d[1], d[0] * d[1] * d[2])));
      const Lanes next = fma(real, below, -(imaginary * above));
      imaginary = fma(real, above, imaginary * below);
      real = next;
    }
    // Near the diagonal each of the two hangs on the direction in which the point lies.
    const auto [from, to] = std::pair(patch.patch.vertices[0], patch.patch.vertices[2]);
    const Lanes half_e = fma(Lanes::load(lengths.data() + 16 * from + first),
                             Lanes::load(lengths.data() + 16 * to + first),
                             dot(to_vertex(from, first), to_vertex(to, first)));
    flag(LaneFlags(half_e < Lanes(2 * near_edge * near_edge)), first);
    return angle_of(imaginary, real) * Lanes(2 * per_angle);
  }

  /// What was integrated, mended.
  void add_patch(std::size_t q) {
    const CagePatch& patch = cage.patches[q];
    const Lanes unit(cage.surface.frame.scaled_diagonal());
    for (std::size_t first = 0; first < 16; first += lanes) {
      Lanes own[8]; // phi, psi
      Lanes hats[4];
      integrals.with_hats(0, first, hats);
      Lanes sum(0.0);
      for (std::size_t k = 0; k < 4; ++k) {
        own[k] = Lanes(per_angle) * hats[k];
        sum += own[k];
      }
      integrals.with_hats(1, first, hats);
      for (std::size_t k = 0; k < 4; ++k) {
        own[4 + k] = Lanes(per_angle) * hats[k];
      }
      Lanes true_sum = solid_angle(patch, first);
      true_sum += nearest_integer(sum - true_sum); // the patch lies elsewhere than the triangles
      winding[first / lanes] += true_sum;
      const Lanes missing_sum = true_sum - sum;
      LaneVector missing(Lanes(0.0), Lanes(0.0), Lanes(0.0));
      for (std::size_t k = 0; k < 4; ++k) {
        const double* const from = rims.data() + 48 * patch.rim[k] + first;
        missing = fma(Lanes(per_angle * patch.rim_sign[k]),
                      LaneVector(Lanes::load(from), Lanes::load(from + 16), Lanes::load(from + 32)),
                      missing);
      }
      const LaneVector x(Lanes::load(&all.x[first]), Lanes::load(&all.y[first]),
                         Lanes::load(&all.z[first]));
      for (std::size_t k = 0; k < 4; ++k) {
        missing = fma(-own[k], to_vertex(patch.patch.vertices[k], first), missing);
        missing = fma(-own[4 + k], LaneVector(patch.patch.normals[k]), missing);
      }
      missing = missing - missing_sum * (LaneVector(patch.least.middle) - x);
      for (std::size_t k = 0; k < 8; ++k) {
        const std::array<double, 4>& f = patch.least.factor[k];
        own[k] +=
            fma(Lanes(f[0]), missing_sum,
                fma(Lanes(f[1]), missing.x, fma(Lanes(f[2]), missing.y, Lanes(f[3]) * missing.z)));
      }
      for (std::size_t k = 0; k < 4; ++k) {
        add(patch.patch.vertices[k], first, own[k]);
        (unit * own[4 + k]).store_unaligned(column(cage.triangles.size() + 4 * q + k, first));
      }
    }
  }

  void put_vertices() const {
    for (std::size_t v = 0; v < vertex_count(); ++v) {
      std::copy_n(phi.data() + 16 * v, 16, out.weights + v * out.stride);
    }
  }
};

void put(const PatchedSurface& cage, const Solution& solution, const WeightsOfTile& out,
         std::size_t i) {
  const std::size_t vertices = cage.surface.cage_vertices;
  const double unit = cage.surface.frame.scaled_diagonal();
  double* const to = out.weights + i;
  for (std::size_t c = 0; c < vertices; ++c) {
    to[c * out.stride] = solution.phi[c];
  }
  for (std::size_t t = 0; t < cage.triangles.size(); ++t) {
    to[(vertices + t) * out.stride] = solution.psi[t] / unit;
  }
  for (std::size_t q = 0; q < cage.patches.size(); ++q) {
    for (std::size_t k = 0; k < 4; ++k) {
      to[cage.patches[q].patch.vertices[k] * out.stride] += solution.patches[q].phi[k];
      to[(vertices + cage.triangles.size() + 4 * q + k) * out.stride] =
          solution.patches[q].psi[k] * unit;
    }
  }
}

TileReport quad_green_tile(const PatchedSurface& cage, const PatchRule& rule,
                           OutsideTreatment outside, std::span<const Vec3> points,
                           const WeightsOfTile& out) {
  TileReport report;
  Integrals integrals(rule, at_patch * cage.surface.frame.scaled_diagonal());
  Tile tile(cage, points, integrals, out);
  std::uint32_t wanted = 0; // those that are done side by side
  for (std::size_t i = 0; i < points.size(); ++i) {
    wanted |= is_usable(points[i]) ? 1U << i : 0U;
  }
  wanted &= ~tile.near;
  for (std::size_t q = 0; q < cage.patches.size(); ++q) {
    integrate(cage.patches[q], points, wanted, integrals);
    wanted &= ~integrals.touched();
    tile.add_patch(q);
  }
  tile.put_vertices();
  alignas(64) std::array<double, 16> winding;
  for (std::size_t first = 0; first < 16; first += lanes) {
    tile.winding[first / lanes].store(&winding[first]);
  }
  const std::size_t columns =
      cage.surface.cage_vertices + cage.triangles.size() + 4 * cage.patches.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    constexpr double sure = 1e-3;
    const auto bit = static_cast<std::uint16_t>(1U << i);
    const bool is_done = ((wanted & ~tile.near) >> i & 1U) != 0;
    if (is_done && std::abs(winding[i] - 1) < sure) {
      continue;
    }
    for (std::size_t k = 0; k < columns; ++k) {
      out.weights[k * out.stride + i] = 0;
    }
    if (!is_usable(points[i])) {
      report.undefined |= bit;
    } else if (is_done && outside != OutsideTreatment::continuation &&
               std::abs(winding[i]) < sure) {
      report.outside |= bit;
    } else if (const auto solution = solve_one(cage, points[i], integrals, outside, bit, report)) {
      put(cage, *solution, out, i);
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

HWY_EXPORT(quad_green_tile);

namespace {

class QuadGreenCoordinates : public PatchedCoordinates {
public:
  QuadGreenCoordinates(std::shared_ptr<const ColumnRule> rule, PatchedSurface surface,
                       const QuadGreenOptions& options)
      : PatchedCoordinates(std::move(rule), std::move(surface), options.outside),
        rule_(patch_rule(options.accuracy)) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return HWY_DYNAMIC_DISPATCH(quad_green_tile)(patched(), rule_, outside(), points,
                                                 {weights, stride});
  }

  const PatchRule& rule_;
};

constexpr std::array<const CoordinateOption*, 2> kind_options = {&accuracy_option, &outside_option};

Result<std::shared_ptr<const Coordinates>>
prepare_kind(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  return quad_green_coordinates(
      cage, {.accuracy = settings.number(accuracy_option),
             .outside = static_cast<OutsideTreatment>(settings.choice(outside_option))});
}

Result<std::shared_ptr<const ColumnRule>> kind_rule(const PolygonMesh& cage,
                                                    const CoordinateSettings&) {
  const Result<PatchedSurface> surface = PatchedSurface::create(cage);
  if (!surface) {
    return surface.error();
  }
  return patch_columns(cage.positions, *surface);
}

} // namespace

Result<std::shared_ptr<const Coordinates>> quad_green_coordinates(const PolygonMesh& cage,
                                                                  const QuadGreenOptions& options) {
  Result<PatchedSurface> surface = PatchedSurface::create(cage);
  if (!surface) {
    return surface.error();
  }
  auto rule = patch_columns(cage.positions, *surface);
  return std::shared_ptr<const Coordinates>(
      std::make_shared<QuadGreenCoordinates>(std::move(rule), *std::move(surface), options));
}

constinit const CoordinateKind quad_green_kind = {
    .name = "quad_green",
    .idea = "Green coordinates of quads as smooth patches, whichever way they are cut",
    .quads = "bilinear",
    .sign = "positive and negative, with normals at corners",
    .reproduces = "similarities",
    .on_cage = "does not interpolate",
    .outside = "refused, at rest, or continued",
    .locality = "global",
    .made_by = "quadrature",
    .cost = "60 ns a point and triangle, a quad being two; 7 in cages of triangles",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = kind_rule,
};

} // namespace cagewright
#endif
