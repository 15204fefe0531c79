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
#include <cagewright/coordinates/quad_green.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
void add_least(const Patch& patch, const Vec3& x, double sum, const Vec3& vector,
               PatchWeights& weights) {
  const Vec3 middle =
      (patch.corners[0] + patch.corners[1] + patch.corners[2] + patch.corners[3]) / 4;
  double size = 0;   // of the patch
  double normal = 0; // of its normals
  for (std::size_t k = 0; k < 4; ++k) {
    size += (patch.corners[k] - middle).norm() / 4;
    normal += patch.normals[k].norm() / 4;
  }
  using Vector4 = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
  using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;
  std::array<Vector4, 8> columns; // of phi, then of psi in units that make them alike
  Matrix4 square = Matrix4::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    columns[k] << 1, (patch.corners[k] - middle) / size;
    columns[4 + k] << 0, patch.normals[k] / normal;
    square += columns[k] * columns[k].transpose() + columns[4 + k] * columns[4 + k].transpose();
  }
  Vector4 missing;
  missing << sum, (vector - sum * (middle - x)) / size;
  const Vector4 factor = square.ldlt().solve(missing);
  for (std::size_t k = 0; k < 4; ++k) {
    weights.phi[k] += factor.dot(columns[k]);
    weights.psi[k] += factor.dot(columns[4 + k]) * size / normal;
  }
}

struct Piecewise {
  const Patch& patch;
  const Vec3& x;
  const SquareRule& rule;
  std::array<PatchMoments, 2> moments;

  void operator()(double u, double v, double side) {
    integrate_piece<2>(
        patch, x, rule, u, v, side,
        [](const PatchNode& p, Lanes(&values)[2]) HWY_ATTR {
          const Lanes square = fma(p.x, p.x, fma(p.y, p.y, p.z * p.z));
          const Lanes along = fma(p.x, p.nx, fma(p.y, p.ny, p.z * p.nz));
          const Lanes inverse = Lanes(1.0) / root(square);
          values[0] = along * inverse * inverse * inverse;
          values[1] = inverse;
        },
        moments);
  }
};

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
                   const SquareRule& rule, std::vector<Touched>& touched) {
  const Surface& surface = cage.surface;
  const double touching = at_patch * surface.frame.scaled_diagonal();
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
    const Patch& patch = cage.patches[q];
    PatchWeights& own = solution.patches.emplace_back();
    Piecewise piecewise{patch, x, rule, {}};
    PatchPieces pieces(patch, x, touching);
    const PatchPlace place =
        pieces.for_each([&](double u, double v, double side) { piecewise(u, v, side); });
    if (place.is_on) {
      const Vec3 normal = patch.normal[0] + place.u * patch.normal[1] + place.v * patch.normal[2];
      touched.push_back({normal.normalized(), q});
      continue;
    }
    own.phi = piecewise.moments[0].with_hats();
    own.psi = piecewise.moments[1].with_hats();
    double sum = 0;
    Vec3 vector = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      own.phi[k] *= per_angle;
      own.psi[k] *= per_angle;
    }
    for (const std::size_t f : patch.faces) {
      (void)add_face(
          f, [](Index, double) {}, sum, vector);
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
    add_least(patch, x, sum, vector, own);
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
  for (const Patch& patch : cage.patches) {
    places.push_back(nearest_on(patch, x));
    distances.push_back(places.back().distance);
  }
  const double reach = 1.5 * *std::ranges::min_element(distances);
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
    const Patch& patch = cage.patches[q];
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
    add_least(patch, x, 0, -(to_place + along * normal), more);
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
                                  const SquareRule& rule, OutsideTreatment outside,
                                  std::uint16_t bit, TileReport& report) {
  if (!is_usable(given)) {
    report.undefined |= bit;
    return std::nullopt;
  }
  Vec3 x = given;
  std::vector<Touched> touched;
  std::optional<PointTerms> point(std::in_place, cage.surface, x);
  Solution solution = solve_off(cage, *point, x, rule, touched);
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
    solution = solve_off(cage, *point, x, rule, again);
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

TileReport quad_green_tile(const PatchedSurface& cage, const SquareRule& rule,
                           OutsideTreatment outside, std::span<const Vec3> points,
                           const WeightsOfTile& out) {
  TileReport report;
  const std::size_t vertices = cage.surface.cage_vertices;
  const std::size_t columns = vertices + cage.triangles.size() + 4 * cage.patches.size();
  const double unit = cage.surface.frame.scaled_diagonal();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      out.weights[k * out.stride + i] = 0;
    }
    const auto bit = static_cast<std::uint16_t>(1U << i);
    const auto solution = solve_one(cage, points[i], rule, outside, bit, report);
    if (!solution) {
      continue;
    }
    double* to = out.weights + i;
    for (std::size_t c = 0; c < vertices; ++c) {
      to[c * out.stride] = solution->phi[c];
    }
    for (std::size_t t = 0; t < cage.triangles.size(); ++t) {
      to[(vertices + t) * out.stride] = solution->psi[t] / unit;
    }
    for (std::size_t q = 0; q < cage.patches.size(); ++q) {
      for (std::size_t k = 0; k < 4; ++k) {
        to[cage.patches[q].vertices[k] * out.stride] += solution->patches[q].phi[k];
        to[(vertices + cage.triangles.size() + 4 * q + k) * out.stride] =
            solution->patches[q].psi[k] * unit;
      }
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
        square_(square_rule(options.accuracy)) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return HWY_DYNAMIC_DISPATCH(quad_green_tile)(patched(), square_, outside(), points,
                                                 {weights, stride});
  }

  const SquareRule& square_;
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
    .cost = "150 ns a point and triangle, a quad being two",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = kind_rule,
};

} // namespace cagewright
#endif
