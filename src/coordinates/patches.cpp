#include "coordinates/patches.h"

#include "core/maths.h"
#include <cagewright/mesh/triangulate.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace cagewright {
namespace {

/// The cage with its quads cut along p0 p2, and which faces were made of which quad.
struct CutQuads {
  PolygonMesh mesh;
  std::vector<std::array<Index, 4>> quads;
  std::vector<std::size_t> quad_of; ///< of each triangle; quads.size(): of none
};

CutQuads cut_quads(const PolygonMesh& cage) {
  CutQuads cut;
  cut.mesh.positions = cage.positions;
  const Triangulation triangulation = triangulate(cage);
  std::vector<Index> owner;
  for (std::size_t t = 0; t < triangulation.triangles.size(); ++t) {
    const Index f = triangulation.face_of[t];
    const std::span<const Index> corners = cage.face(f);
    if (corners.size() != 4) {
      cut.mesh.add_face(triangulation.triangles[t]);
      owner.push_back(std::numeric_limits<Index>::max());
      continue;
    }
    const bool is_second = t > 0 && triangulation.face_of[t - 1] == f;
    if (!is_second) {
      cut.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
    }
    const std::array<Index, 4>& quad = cut.quads.back();
    cut.mesh.add_face(is_second ? std::array{quad[0], quad[2], quad[3]}
                                : std::array{quad[0], quad[1], quad[2]});
    owner.push_back(static_cast<Index>(cut.quads.size() - 1));
  }
  for (const Index quad : owner) {
    cut.quad_of.push_back(std::min<std::size_t>(quad, cut.quads.size()));
  }
  return cut;
}

} // namespace

Patch make_patch(const std::array<Vec3, 4>& p) {
  Patch patch;
  patch.corners = p;
  for (std::size_t k = 0; k < 4; ++k) {
    patch.normals[k] = (p[(k + 1) % 4] - p[k]).cross(p[(k + 3) % 4] - p[k]);
  }
  patch.position = {p[0], p[1] - p[0], p[3] - p[0], (p[2] - p[1]) - (p[3] - p[0])};
  const std::array<Vec3, 4>& c = patch.position;
  // (c1 + v c3) x (c2 + u c3)
  patch.normal = {c[1].cross(c[2]), c[1].cross(c[3]), c[3].cross(c[2])};
  return patch;
}

LeastChange::LeastChange(const Patch& patch)
    : middle((patch.corners[0] + patch.corners[1] + patch.corners[2] + patch.corners[3]) / 4) {
  double size = 0;   // of the patch
  double normal = 0; // of its normals
  for (std::size_t k = 0; k < 4; ++k) {
    size += (patch.corners[k] - middle).norm() / 4;
    normal += patch.normals[k].norm() / 4;
  }
  using Vector4 = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
  using Matrix4 = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;
  std::array<Vector4, 8> columns; // those of the normals in units that make them alike
  Matrix4 square = Matrix4::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    columns[k] << 1, (patch.corners[k] - middle) / size;
    columns[4 + k] << 0, patch.normals[k] / normal;
    square += columns[k] * columns[k].transpose() + columns[4 + k] * columns[4 + k].transpose();
  }
  const Eigen::LDLT<Matrix4> solver(square);
  for (std::size_t k = 0; k < 8; ++k) {
    Vector4 row = solver.solve(columns[k]);
    row.tail<3>() /= size;
    row *= k < 4 ? 1 : size / normal;
    std::copy_n(row.data(), 4, factor[k].begin());
  }
}

Result<PatchedSurface> PatchedSurface::create(const PolygonMesh& cage) {
  const CutQuads cut = cut_quads(cage);
  Result<Surface> surface = Surface::create(cut.mesh, QuadTreatment::diagonal);
  if (!surface) {
    return surface.error();
  }
  PatchedSurface patched{*std::move(surface), {}, {}, {}, {}};
  std::vector<std::vector<std::size_t>> faces_of(cut.quads.size());
  std::vector<Triangle> plain;
  for (std::size_t f = 0; f < patched.surface.faces.size(); ++f) {
    const std::size_t quad = cut.quad_of[patched.surface.source[f]];
    if (quad == cut.quads.size()) {
      patched.triangles.push_back(f);
      plain.push_back(patched.surface.faces[f].vertices);
    } else {
      faces_of[quad].push_back(f);
    }
  }
  patched.without_quads =
      Surface::of_triangles(patched.surface.frame, patched.surface.positions, plain);
  std::map<std::pair<Index, Index>, std::size_t> rims;
  for (std::size_t q = 0; q < cut.quads.size(); ++q) {
    if (faces_of[q].empty()) {
      continue;
    }
    std::array<Index, 4> vertices = cut.quads[q];
    if (patched.surface.is_turned) {
      std::swap(vertices[1], vertices[3]);
    }
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = patched.surface.positions[vertices[k]];
    }
    Patch patch = make_patch(corners);
    patch.vertices = vertices;
    CagePatch made{patch, LeastChange(patch), {}, {}, {}, faces_of[q].size()};
    std::copy(faces_of[q].begin(), faces_of[q].end(), made.triangles.begin());
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [from, to] = std::minmax(vertices[k], vertices[(k + 1) % 4]);
      const auto [found, is_new] = rims.try_emplace({from, to}, patched.rims.size());
      if (is_new) {
        const Vec3 edge = patched.surface.positions[to] - patched.surface.positions[from];
        const double length = edge.norm();
        patched.rims.push_back({from, to, length > 0 ? Vec3(edge / length) : Vec3(edge), length});
      }
      made.rim[k] = found->second;
      made.rim_sign[k] = vertices[k] == from ? 1 : -1;
    }
    patched.patches.push_back(std::move(made));
  }
  return patched;
}

LineRule::LineRule(std::size_t count) {
  const auto n = static_cast<long double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    long double x = maths::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) /
                               (static_cast<double>(count) + 0.5));
    long double slope = 1;
    for (int step = 0; step < 10; ++step) { // Newton's method
      long double last = 1;
      long double value = x;
      for (std::size_t k = 2; k <= count; ++k) {
        const auto order = static_cast<long double>(k);
        last = std::exchange(value, ((2 * order - 1) * x * value - (order - 1) * last) / order);
      }
      slope = n * (x * value - last) / (x * x - 1);
      x -= value / slope;
    }
    at.push_back(static_cast<double>((1 + x) / 2));
    weight.push_back(static_cast<double>(1 / ((1 - x * x) * slope * slope)));
  }
}

namespace {

/// The error of Gauss's rule with n nodes a side for a piece of radius r as seen from a distance of
/// 1, as a part of all that is seen. The rule errs by rho^(-2 n), rho the sum of the half axes of
/// the ellipse round a side, with foci at its ends, up to which the integrand is analytic. Worst
/// is a point in the direction of a corner: 1 / r half sides away along the side, at least. Of the
/// full solid angle the piece takes 2 r^2 / 4 pi.
double gauss_error(std::size_t n, double r) {
  const double rho = (1 + std::sqrt(1 - r * r)) / r;
  return maths::pow(rho, -2.0 * static_cast<double>(n)) * r * r / (2 * std::numbers::pi);
}

} // namespace

PatchRule::PatchRule(std::size_t along_a_side, double accuracy) {
  for (const std::size_t part : {2, 3, 4, 5, 6}) {
    const std::size_t count = along_a_side * part / 4;
    double low = 0;
    double high = 1;
    for (int step = 0; step < 40; ++step) {
      const double middle = (low + high) / 2;
      (gauss_error(count, middle) < accuracy ? low : high) = middle;
    }
    choices.push_back({LineRule(count), low * low});
  }
}

const PatchRule& patch_rule(double accuracy) {
  // Errors of pieces sum up, and the largest weight is a part of the sum.
  constexpr double of_all = 1 / 20.0;
  static const PatchRule four(4, 1e-6 * of_all);
  static const PatchRule six(6, 1e-8 * of_all);
  static const PatchRule twelve(12, 1e-14 * of_all);
  if (accuracy <= 0 || accuracy >= 1e-7) {
    return four;
  }
  return accuracy >= 1e-9 ? six : twelve;
}

} // namespace cagewright
