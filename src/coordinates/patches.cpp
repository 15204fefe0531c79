#include "coordinates/patches.h"

#include "core/maths.h"
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace cagewright {
namespace {

/// Nodes and weights on [0, 1].
std::vector<std::pair<double, double>> gauss(std::size_t count) {
  std::vector<std::pair<double, double>> rule;
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
    rule.emplace_back(static_cast<double>((1 + x) / 2),
                      static_cast<double>(1 / ((1 - x * x) * slope * slope)));
  }
  return rule;
}

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

Result<PatchedSurface> PatchedSurface::create(const PolygonMesh& cage) {
  const CutQuads cut = cut_quads(cage);
  Result<Surface> surface = Surface::create(cut.mesh, QuadTreatment::diagonal);
  if (!surface) {
    return surface.error();
  }
  PatchedSurface patched{*std::move(surface), {}, {}};
  std::vector<std::vector<std::size_t>> faces_of(cut.quads.size());
  for (std::size_t f = 0; f < patched.surface.faces.size(); ++f) {
    const std::size_t quad = cut.quad_of[patched.surface.source[f]];
    if (quad == cut.quads.size()) {
      patched.triangles.push_back(f);
    } else {
      faces_of[quad].push_back(f);
    }
  }
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
    patch.faces = faces_of[q];
    patched.patches.push_back(std::move(patch));
  }
  return patched;
}

SquareRule::SquareRule(std::size_t along_a_side) {
  const auto line = gauss(along_a_side);
  for (const auto& [at_u, weight_u] : line) {
    for (const auto& [at_v, weight_v] : line) {
      u.push_back(at_u);
      v.push_back(at_v);
      weight.push_back(weight_u * weight_v);
    }
  }
  while (weight.size() % 8 != 0) {
    u.push_back(0.5);
    v.push_back(0.5);
    weight.push_back(0);
  }
}

const SquareRule& square_rule(double accuracy) {
  static const SquareRule four(4);
  static const SquareRule six(6);
  static const SquareRule twelve(12);
  if (accuracy <= 0 || accuracy >= 1e-7) {
    return four;
  }
  return accuracy >= 1e-9 ? six : twelve;
}

} // namespace cagewright
