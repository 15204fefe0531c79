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
#include <cagewright/coordinates/quad_mean_value.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

/// Half the sum of angle times unit normal over the edges of the rim.
Vec3 rim_vector(const std::array<Vec3, 4>& a) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t e = 0; e < 4; ++e) {
    const Vec3 normal = a[e].cross(a[(e + 1) % 4]);
    const double size = normal.norm();
    if (size > 0) {
      sum += angle_of(size, a[e].dot(a[(e + 1) % 4])) / (2 * size) * normal;
    }
  }
  return sum;
}

/// The least change of the weights after which they give the vector of the rim.
void mend(const std::array<Vec3, 4>& a, std::array<double, 4>& weights) {
  Vec3 missing = rim_vector(a);
  double size = 0;
  Mat3 square = Mat3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    missing -= weights[k] * a[k];
    size += std::abs(weights[k]) * a[k].norm();
    square += a[k] * a[k].transpose();
  }
  if (missing.norm() < 1e-15 * size) {
    return; // that is rounding
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(square);
  // Seen edge on, a patch has no say in the direction across, and nothing is missing there.
  constexpr double edge_on = 1e-12;
  Vec3 factor = Vec3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double value = solver.eigenvalues()[i];
    if (value > edge_on * solver.eigenvalues()[2]) {
      const Vec3 axis = solver.eigenvectors().col(i);
      factor += axis.dot(missing) / value * axis;
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    weights[k] += factor.dot(a[k]);
  }
}

struct Piecewise {
  const Patch& patch;
  const Vec3& x;
  const SquareRule& rule;
  std::array<PatchMoments, 1> moments;

  void operator()(double u, double v, double side) {
    integrate_piece<1>(
        patch, x, rule, u, v, side,
        [](const PatchNode& p, Lanes(&values)[1]) HWY_ATTR {
          const Lanes square = fma(p.x, p.x, fma(p.y, p.y, p.z * p.z));
          const Lanes along = fma(p.x, p.nx, fma(p.y, p.ny, p.z * p.nz));
          values[0] = along / (square * square);
        },
        moments);
  }
};

/// The weights of one point. \returns false where there are none
bool solve_one(const PatchedSurface& cage, const Vec3& x, const SquareRule& rule,
               std::vector<double>& weights, bool& on_surface) {
  const PointTerms point(cage.surface, x);
  const double unit = cage.surface.frame.scaled_diagonal();
  for (const std::size_t f : cage.triangles) {
    const Surface::Face& face = cage.surface.faces[f];
    if (point.touches(f)) {
      on_surface = true;
      std::ranges::fill(weights, 0.0);
      const std::array<double, 3> hats = hats_on(point, f);
      for (std::size_t k = 0; k < 3; ++k) {
        weights[face.vertices[k]] = hats[k];
      }
      return true;
    }
    double own[3];
    view_weights_of(cage.surface, point, f, own);
    for (std::size_t k = 0; k < 3; ++k) {
      weights[face.vertices[k]] += own[k];
    }
  }
  for (const Patch& patch : cage.patches) {
    Piecewise piecewise{patch, x, rule, {}};
    PatchPieces pieces(patch, x, on_patch * unit);
    const PatchPlace place =
        pieces.for_each([&](double u, double v, double side) { piecewise(u, v, side); });
    if (place.is_on) {
      on_surface = true;
      std::ranges::fill(weights, 0.0);
      const std::array<double, 4> hats = hats_at(place.u, place.v);
      for (std::size_t k = 0; k < 4; ++k) {
        weights[patch.vertices[k]] += hats[k];
      }
      return true;
    }
    std::array<double, 4> own = piecewise.moments[0].with_hats();
    std::array<Vec3, 4> seen;
    for (std::size_t k = 0; k < 4; ++k) {
      seen[k] = point.to_vertex(patch.vertices[k]);
    }
    mend(seen, own);
    for (std::size_t k = 0; k < 4; ++k) {
      weights[patch.vertices[k]] += own[k];
    }
  }
  double sum = 0;
  double size = 0;
  for (const double w : weights) {
    sum += w;
    size += std::abs(w);
  }
  constexpr double noise = 1e-11;
  if (!(std::abs(sum) > noise * size) || !std::isfinite(size)) {
    return false;
  }
  for (double& w : weights) {
    w /= sum;
  }
  return true;
}

TileReport quad_mean_value_tile(const PatchedSurface& cage, const SquareRule& rule,
                                std::span<const Vec3> points, const WeightsOfTile& out) {
  TileReport report;
  std::vector<double> weights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto bit = static_cast<std::uint16_t>(1U << i);
    weights.assign(cage.surface.positions.size(), 0.0);
    bool on_surface = false;
    if (!is_usable(points[i]) || !solve_one(cage, points[i], rule, weights, on_surface)) {
      report.undefined |= bit;
      std::ranges::fill(weights, 0.0);
    }
    if (on_surface) {
      report.on_surface |= bit;
    }
    put_vertices_of(cage.surface, weights, out.weights, out.stride, i);
  }
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
        rule_(square_rule(accuracy)) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return HWY_DYNAMIC_DISPATCH(quad_mean_value_tile)(patched(), rule_, points, {weights, stride});
  }

  const SquareRule& rule_;
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
    .cost = "150 ns a point and triangle, a quad being two",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = vertex_rule,
};

} // namespace cagewright
#endif
