// Mean value coordinates with bilinear quads. Compiled once for each instruction set (Highway
// includes this file again and again); the best is chosen when the program runs.
//
//     w_k = the integral of B_k (P - x) . N / r^4 du dv over the patch.
//
// What Gauss's rule leaves is mended: the sum of w_k (p_k - x) hangs on the rim of the patch alone,
// and is half the sum over its edges of the angle under which they are seen times the unit normal
// of the plane through edge and point.

#include "coordinates/patches.h"
#include "coordinates/surface_coordinates.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/mean_value.h>
#include <cagewright/coordinates/quad_mean_value.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/quad_mean_value_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/patch_quadrature-inl.h"
#include "coordinates/view_angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

/// Nearer than this to a patch, in diagonals, a point lies on it.
constexpr double on_patch = 1e-9;

/// (P - x) . N / r^4.
struct MeanValueKernel {
  HWY_INLINE void operator()(const Lanes (&square)[1], const Lanes (&along)[1],
                             Lanes (&values)[1][1]) const {
    values[0][0] = along[0] / (square[0] * square[0]);
  }
  HWY_INLINE void operator()(const Lanes (&square)[2], const Lanes (&along)[2],
                             Lanes (&values)[2][1]) const {
    const Lanes first = square[0] * square[0];
    const Lanes second = square[1] * square[1];
    const Lanes inverse = Lanes(1.0) / (first * second);
    values[0][0] = along[0] * (inverse * second);
    values[1][0] = along[1] * (inverse * first);
  }
};

/// What Gauss's rule leaves is below this share of the terms: rounding.
constexpr double rounding = 1e-15;

/// Half the angle under which an edge is seen times the unit normal of the plane through it and the
/// point, of several points.
HWY_INLINE LaneVector rim_vector(const LaneVector& a, const LaneVector& b) {
  const LaneVector normal = cross(a, b);
  const Lanes size = root(dot(normal, normal));
  return Lanes(0.5) * angle_of(size, dot(a, b)) / larger(size, Lanes(1e-300)) * normal;
}

/// The least change of the weights of corners a after which the sum of w a is `rim`.
HWY_INLINE void mend(const LaneVector (&a)[4], const LaneVector& rim, Lanes (&weights)[4]) {
  LaneVector missing = rim;
  Lanes size(0.0);
  Lanes xx(0.0), xy(0.0), xz(0.0), yy(0.0), yz(0.0), zz(0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    missing = fma(-weights[k], a[k], missing);
    size = fma(weights[k] * weights[k], dot(a[k], a[k]), size);
    xx = fma(a[k].x, a[k].x, xx);
    xy = fma(a[k].x, a[k].y, xy);
    xz = fma(a[k].x, a[k].z, xz);
    yy = fma(a[k].y, a[k].y, yy);
    yz = fma(a[k].y, a[k].z, yz);
    zz = fma(a[k].z, a[k].z, zz);
  }
  const Mask matters = dot(missing, missing) > Lanes(rounding * rounding) * size;
  missing = {select(matters, missing.x, Lanes(0.0)), select(matters, missing.y, Lanes(0.0)),
             select(matters, missing.z, Lanes(0.0))};
  // Seen edge on, a patch has no say in the direction across, and nothing is missing there: so the
  // matrix is made regular, and what that leaves is taken out by a second step.
  constexpr double edge_on = 1e-13;
  const Lanes more = Lanes(edge_on) * (xx + yy + zz);
  const Lanes dx = Lanes(1.0) / (xx + more);
  const Lanes lxy = xy * dx;
  const Lanes lxz = xz * dx;
  const Lanes dy = Lanes(1.0) / (yy + more - lxy * xy);
  const Lanes ryz = yz - lxz * xy;
  const Lanes lyz = ryz * dy;
  const Lanes dz = Lanes(1.0) / larger(zz + more - lxz * xz - lyz * ryz, Lanes(1e-300));
  for (int step = 0; step < 2; ++step) {
    const Lanes sy = missing.y - lxy * missing.x;
    const Lanes fz = (missing.z - lxz * missing.x - lyz * sy) * dz;
    const Lanes fy = sy * dy - lyz * fz;
    const Lanes fx = missing.x * dx - lxy * fy - lxz * fz;
    const LaneVector factor(fx, fy, fz);
    for (std::size_t k = 0; k < 4; ++k) {
      const Lanes change = dot(factor, a[k]);
      weights[k] += change;
      missing = fma(-change, a[k], missing);
    }
  }
}

/// The weights of a point that lies on the cage.
struct OnCage {
  std::array<Index, 4> vertices{};
  std::array<double, 4> hats{};
};

/// What all points of a tile are computed with.
struct Tile {
  const PatchedSurface& cage;
  std::span<const Vec3> points;
  SixteenPoints all;
  AlignedBuffer<double> weights; ///< of vertices: sixteen each
  AlignedBuffer<double> rims;    ///< the vectors of edges, coordinate after coordinate
  PatchIntegrals<1> integrals;

  Tile(const PatchedSurface& patched, const PatchRule& rule, std::span<const Vec3> given)
      : cage(patched), points(given), all(given), weights(16 * patched.surface.positions.size()),
        rims(48 * patched.rims.size()),
        integrals(rule, on_patch * patched.surface.frame.scaled_diagonal()) {
    std::fill_n(weights.data(), 16 * patched.surface.positions.size(), 0.0);
  }

  [[nodiscard]] HWY_INLINE LaneVector to_vertex(Index vertex, std::size_t first) const {
    return LaneVector(cage.surface.positions[vertex]) - LaneVector(Lanes::load(&all.x[first]),
                                                                   Lanes::load(&all.y[first]),
                                                                   Lanes::load(&all.z[first]));
  }
  HWY_INLINE void add(Index vertex, std::size_t first, Lanes what) {
    double* const to = weights.data() + 16 * vertex + first;
    (Lanes::load(to) + what).store(to);
  }

  /// \returns one bit for each point that is too near to edges and faces for this, or too far from
  ///          all, where front and back of the cage cancel
  std::uint32_t add_triangles() {
    std::uint32_t near = 0;
    if (cage.triangles.empty()) {
      return near;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_far = !(points[i].norm() < cage.surface.frame.scaled_diagonal());
      near |= is_far ? 1U << i : 0U;
    }
    const Surface& surface = cage.without_quads;
    AlignedBuffer<double> scratch(LaneViews::scratch_size(surface));
    for (std::size_t first = 0; first < 16; first += lanes) {
      LaneViews views(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
      for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        Lanes own[3];
        (void)views.weights(f, own);
        for (std::size_t k = 0; k < 3; ++k) {
          add(surface.faces[f].vertices[k], first, own[k]);
        }
      }
      const LaneFlags flags = views.near();
      for (std::size_t k = 0; k < lanes; ++k) {
        near |= flags[k] ? 1U << (first + k) : 0U;
      }
    }
    return near;
  }

  void make_rims() {
    for (std::size_t e = 0; e < cage.rims.size(); ++e) {
      for (std::size_t first = 0; first < 16; first += lanes) {
        const LaneVector vector =
            rim_vector(to_vertex(cage.rims[e].from, first), to_vertex(cage.rims[e].to, first));
        vector.x.store(rims.data() + 48 * e + first);
        vector.y.store(rims.data() + 48 * e + 16 + first);
        vector.z.store(rims.data() + 48 * e + 32 + first);
      }
    }
  }

  void integrate(const CagePatch& patch, std::uint32_t wanted) {
    integrals.run(patch.patch, points, wanted, MeanValueKernel());
  }

  /// What was integrated, mended.
  void add_patch(const CagePatch& patch) {
    for (std::size_t first = 0; first < 16; first += lanes) {
      Lanes own[4];
      integrals.with_hats(0, first, own);
      LaneVector rim(Lanes(0.0), Lanes(0.0), Lanes(0.0));
      LaneVector corners[4];
      for (std::size_t k = 0; k < 4; ++k) {
        corners[k] = to_vertex(patch.patch.vertices[k], first);
        const double* const from = rims.data() + 48 * patch.rim[k] + first;
        rim =
            fma(Lanes(patch.rim_sign[k]),
                LaneVector(Lanes::load(from), Lanes::load(from + 16), Lanes::load(from + 32)), rim);
      }
      mend(corners, rim, own);
      for (std::size_t k = 0; k < 4; ++k) {
        add(patch.patch.vertices[k], first, own[k]);
      }
    }
  }

  /// \returns one bit for each point that has no sum to speak of
  std::uint32_t normalize() {
    std::uint32_t without = 0;
    const std::size_t count = cage.surface.positions.size();
    for (std::size_t first = 0; first < 16; first += lanes) {
      Lanes sum(0.0);
      Lanes size(0.0);
      for (std::size_t v = 0; v < count; ++v) {
        const Lanes w = Lanes::load(weights.data() + 16 * v + first);
        sum += w;
        size += absolute(w);
      }
      constexpr double noise = 1e-11;
      const LaneFlags some((absolute(sum) > Lanes(noise) * size) & (size < Lanes(1e300)));
      const Lanes factor = Lanes(1.0) / sum;
      for (std::size_t v = 0; v < count; ++v) {
        double* const to = weights.data() + 16 * v + first;
        (Lanes::load(to) * factor).store(to);
      }
      for (std::size_t k = 0; k < lanes; ++k) {
        without |= some[k] ? 0U : 1U << (first + k);
      }
    }
    return without;
  }

  /// The triangles once more, for a point near them. \returns whether it lies on one
  bool add_triangles_with_care(std::size_t i, OnCage& on) {
    const Surface& surface = cage.without_quads;
    const PointTerms point(surface, points[i]);
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
      weights.data()[16 * v + i] = 0;
    }
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const std::array<Index, 3>& v = surface.faces[f].vertices;
      if (point.touches(f)) {
        const std::array<double, 3> hats = hats_on(point, f);
        on = {{v[0], v[1], v[2], v[2]}, {hats[0], hats[1], hats[2], 0}};
        return true;
      }
      double own[3];
      view_weights_of(surface, point, f, own);
      for (std::size_t k = 0; k < 3; ++k) {
        weights.data()[16 * v[k] + i] += own[k];
      }
    }
    return false;
  }
};

/// Which of `count` points lie on the cage, or have no weights otherwise; one bit each.
struct Tally {
  std::uint32_t on_surface = 0;
  std::uint32_t undefined = 0;
  std::array<OnCage, 16> places; ///< of those on the surface
};

void put(const Tile& tile, const Tally& tally, const WeightsOfTile& out) {
  for (std::size_t v = 0; v < tile.cage.surface.cage_vertices; ++v) {
    std::copy_n(tile.weights.data() + 16 * v, 16, out.weights + v * out.stride);
  }
  for (std::size_t i = 0; i < tile.points.size(); ++i) {
    const bool is_on = (tally.on_surface >> i & 1U) != 0;
    if (!is_on && (tally.undefined >> i & 1U) == 0) {
      continue;
    }
    for (std::size_t v = 0; v < tile.cage.surface.cage_vertices; ++v) {
      out.weights[v * out.stride + i] = 0;
    }
    for (std::size_t k = 0; is_on && k < 4; ++k) {
      out.weights[tally.places[i].vertices[k] * out.stride + i] += tally.places[i].hats[k];
    }
  }
}

TileReport quad_mean_value_tile(const PatchedSurface& cage, const PatchRule& rule,
                                std::span<const Vec3> points, const WeightsOfTile& out) {
  Tile tile(cage, rule, points);
  Tally tally;
  std::uint32_t wanted = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    (is_usable(points[i]) ? wanted : tally.undefined) |= 1U << i;
  }
  const std::uint32_t near = tile.add_triangles() & wanted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((near >> i & 1U) != 0 && tile.add_triangles_with_care(i, tally.places[i])) {
      tally.on_surface |= 1U << i;
    }
  }
  tile.make_rims();
  for (const CagePatch& patch : cage.patches) {
    tile.integrate(patch, wanted & ~tally.on_surface);
    const std::uint32_t touched = tile.integrals.touched();
    for (std::size_t i = 0; touched != 0 && i < points.size(); ++i) {
      if ((touched >> i & 1U) != 0) {
        const PatchPlace place = tile.integrals.place(patch.patch, points[i], i);
        tally.places[i] = {patch.patch.vertices, hats_at(place.u, place.v)};
      }
    }
    tally.on_surface |= touched;
    tile.add_patch(patch);
  }
  tally.undefined |= tile.normalize() & wanted & ~tally.on_surface;
  put(tile, tally, out);
  TileReport report;
  report.on_surface = static_cast<std::uint16_t>(tally.on_surface);
  report.undefined = static_cast<std::uint16_t>(tally.undefined);
  return report;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(quad_mean_value_tile);

namespace {

class QuadMeanValueCoordinates : public PatchedCoordinates {
public:
  QuadMeanValueCoordinates(const PolygonMesh& cage, PatchedSurface surface, double accuracy)
      : PatchedCoordinates(vertex_columns(cage.positions), std::move(surface),
                           OutsideTreatment::rest),
        rule_(patch_rule(accuracy)) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return HWY_DYNAMIC_DISPATCH(quad_mean_value_tile)(patched(), rule_, points, {weights, stride});
  }

  const PatchRule& rule_;
};

constexpr std::array<const CoordinateOption*, 1> kind_options = {&accuracy_option};

Result<std::shared_ptr<const Coordinates>>
prepare_kind(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  return quad_mean_value_coordinates(cage, {.accuracy = settings.number(accuracy_option)});
}

} // namespace

Result<std::shared_ptr<const Coordinates>>
quad_mean_value_coordinates(const PolygonMesh& cage, const QuadMeanValueOptions& options) {
  Result<PatchedSurface> surface = PatchedSurface::create(cage);
  if (!surface) {
    return surface.error();
  }
  if (surface->patches.empty()) { // that is mean value, which is quicker, and exact far outside
    return prepare_coordinates(cage, CoordinateSettings(mean_value_kind));
  }
  return std::shared_ptr<const Coordinates>(
      std::make_shared<QuadMeanValueCoordinates>(cage, *std::move(surface), options.accuracy));
}

constinit const CoordinateKind quad_mean_value_kind = {
    .name = "quad_mean_value",
    .idea = "mean value coordinates of quads as smooth patches, whichever way they are cut",
    .quads = "bilinear",
    .sign = "positive and negative",
    .reproduces = "affine maps",
    .on_cage = "interpolates",
    .outside = "everywhere",
    .locality = "global",
    .made_by = "quadrature",
    .cost = "50 ns a point and triangle, a quad being two; in cages of triangles as mean_value",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = vertex_rule,
};

} // namespace cagewright
#endif
