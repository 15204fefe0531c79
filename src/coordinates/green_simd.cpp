// Green coordinates, several points side by side. Compiled once for each instruction set (Highway
// includes this file again and again); the best is chosen when the program runs.
//
// With h the height over the plane of a face, Omega its solid angle, L_e the integral of 1 / r
// along edge e, q = sum of L_e nu_e, lambda the barycentric coordinates of the point's projection
// and g_i their gradients,
//     phi_i = sum over the faces of (lambda_i Omega - h g_i . q) / 4 pi,
//     psi_t = (sum of rho_e L_e - h Omega) / 4 pi.

#include "coordinates/normal_columns.h"
#include "coordinates/surface_coordinates.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/green.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/green_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/triangle_integrals-inl.h"

#ifndef CAGEWRIGHT_COORDINATES_GREEN_TILE
#define CAGEWRIGHT_COORDINATES_GREEN_TILE
namespace cagewright {
namespace {

/// Sixteen points of which so many count, and where their weights go.
struct GreenTile {
  std::span<const Vec3> points; ///< in the frame
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

constexpr double per_angle = 1 / full_angle;

/// The weights of one point that is near the cage, on it, or outside: all columns, with stride 1,
/// the middles of quads behind the vertices and before the normals.
void solve_one(const Surface& surface, const GreenTile& tile, std::size_t i, TileReport& report) {
  const std::size_t vertices = surface.positions.size();
  std::vector<double> phi(vertices, 0.0);
  std::vector<double> psi(surface.faces.size(), 0.0);
  const auto bit = static_cast<std::uint16_t>(1U << i);
  const auto put = [&] {
    put_vertices_of(surface, phi, tile.weights, tile.stride, i);
    const double unit = surface.frame.scaled_diagonal();
    for (std::size_t f = 0; f < psi.size(); ++f) {
      tile.weights[(surface.cage_vertices + f) * tile.stride + i] = psi[f] / unit;
    }
  };
  const Vec3& x = tile.points[i];
  if (!is_usable(x)) {
    report.undefined |= bit;
    put();
    return;
  }
  const PointTerms point(surface, x);
  const PointPlace place = place_of(surface, point);
  if (place.outside) {
    report.outside |= bit;
    if (tile.outside != OutsideTreatment::continuation) {
      put();
      return;
    }
  }
  double missing = place.on_surface ? 1 : 0; // of the solid angle, over 4 pi
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Surface::Face& face = surface.faces[f];
    const FaceTerms<double>& terms = point.face(f);
    psi[f] = per_angle * terms.potential();
    if (place.on_surface && point.touches(f)) {
      continue;
    }
    missing -= place.on_surface ? per_angle * terms.omega : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      phi[face.vertices[k]] +=
          per_angle * (terms.lambda[k] * terms.omega - terms.height * terms.slope(face, k));
    }
  }
  if (place.on_surface) {
    report.on_surface |= bit;
    for (const auto& [vertex, hat] : place.hats) {
      phi[vertex] += missing * hat;
    }
  } else if (place.outside) {
    const double turns = 1 - place.winding;
    for (const auto& [f, share] : place.through) {
      for (std::size_t k = 0; k < 3; ++k) {
        phi[surface.faces[f].vertices[k]] += turns * share * point.face(f).lambda[k];
      }
      psi[f] -= turns * share * point.face(f).height;
    }
  } else if (place.winding > 1) { // inside parts of the cage that overlap: the mean of the parts
    for (double& w : phi) {
      w /= place.winding;
    }
    for (double& w : psi) {
      w /= place.winding;
    }
  }
  put();
}

TileReport green_tile(const Surface& surface, const GreenTile& tile) {
  const std::size_t vertices = surface.positions.size();
  const SixteenPoints all(tile.points);
  AlignedBuffer<double> scratch(LanePoints::scratch_size(surface) + vertices * lanes);
  double* const phi = scratch.data() + LanePoints::scratch_size(surface);
  const Lanes psi_unit(per_angle / surface.frame.scaled_diagonal());
  std::array<bool, 16> again{};
  for (std::size_t first = 0; first < 16; first += lanes) {
    LanePoints points(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
    std::fill_n(phi, vertices * lanes, 0.0);
    double* const out = tile.weights + first;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const Surface::Face& face = surface.faces[f];
      const FaceTerms<Lanes> terms = points.face(f);
      for (std::size_t k = 0; k < 3; ++k) {
        double* const sum = phi + face.vertices[k] * lanes;
        const Lanes share = terms.lambda[k] * terms.omega - terms.height * terms.slope(face, k);
        fma(share, Lanes(per_angle), Lanes::load(sum)).store(sum);
      }
      (terms.potential() * psi_unit)
          .store_unaligned(out + (surface.cage_vertices + f) * tile.stride);
    }
    put_vertices(surface, phi, out, tile.stride);
    const LaneFlags flagged = points.flagged();
    for (std::size_t i = 0; i < lanes; ++i) {
      again[first + i] = flagged[i];
    }
  }
  TileReport report;
  for (std::size_t i = 0; i < tile.points.size(); ++i) {
    if (again[i]) {
      solve_one(surface, tile, i, report);
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

HWY_EXPORT(green_tile);

namespace {

class GreenCoordinates : public SurfaceCoordinates {
public:
  GreenCoordinates(std::shared_ptr<const ColumnRule> rule, Surface surface,
                   OutsideTreatment outside)
      : SurfaceCoordinates(std::move(rule), std::move(surface), outside) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return HWY_DYNAMIC_DISPATCH(green_tile)(surface(), {points, outside(), weights, stride});
  }
};

constexpr std::array<const CoordinateOption*, 2> kind_options = {&quads_option, &outside_option};

GreenOptions options_of(const CoordinateSettings& settings) {
  return {.quads = static_cast<QuadTreatment>(settings.choice(quads_option)),
          .outside = static_cast<OutsideTreatment>(settings.choice(outside_option))};
}

Result<std::shared_ptr<const Coordinates>>
prepare_kind(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  return green_coordinates(cage, options_of(settings));
}

Result<std::shared_ptr<const ColumnRule>> kind_rule(const PolygonMesh& cage,
                                                    const CoordinateSettings& settings) {
  const Result<Surface> surface = Surface::create(cage, options_of(settings).quads);
  if (!surface) {
    return surface.error();
  }
  return normal_columns(cage.positions, *surface);
}

} // namespace

Result<std::shared_ptr<const Coordinates>> green_coordinates(const PolygonMesh& cage,
                                                             const GreenOptions& options) {
  Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  auto rule = normal_columns(cage.positions, *surface);
  return std::shared_ptr<const Coordinates>(
      std::make_shared<GreenCoordinates>(std::move(rule), *std::move(surface), options.outside));
}

constinit const CoordinateKind green_kind = {
    .name = "green",
    .idea = "the cage's vertices and the normals of its faces: bends and twists without shearing",
    .quads = "center or diagonal",
    .sign = "positive and negative, with normals",
    .reproduces = "similarities",
    .on_cage = "does not interpolate",
    .outside = "refused, at rest, or continued",
    .locality = "global",
    .made_by = "closed form",
    .cost = "6 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = kind_rule,
};

} // namespace cagewright
#endif
