#include "mesh/shapes.h"

#include "core/maths.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace cagewright {

TriangleMesh make_cube() {
  TriangleMesh cube;
  for (unsigned i = 0; i < 8; ++i) {
    cube.positions.emplace_back((i & 1U) ? 1.0 : -1.0, (i & 2U) ? 1.0 : -1.0,
                                (i & 4U) ? 1.0 : -1.0);
  }
  // clang-format off
  cube.triangles = {{0, 4, 6}, {0, 6, 2},   // x = -1
                    {1, 3, 7}, {1, 7, 5},   // x = +1
                    {0, 1, 5}, {0, 5, 4},   // y = -1
                    {2, 6, 7}, {2, 7, 3},   // y = +1
                    {0, 2, 3}, {0, 3, 1},   // z = -1
                    {4, 5, 7}, {4, 7, 6}};  // z = +1
  // clang-format on
  return cube;
}

PolygonMesh make_quad_cube() {
  PolygonMesh cube;
  cube.positions = make_cube().positions;
  for (const std::array<Index, 4>& face : {std::array<Index, 4>{0, 4, 6, 2},
                                           {1, 3, 7, 5},
                                           {0, 1, 5, 4},
                                           {2, 6, 7, 3},
                                           {0, 2, 3, 1},
                                           {4, 5, 7, 6}}) {
    cube.add_face(face);
  }
  return cube;
}

TriangleMesh make_tetrahedron() {
  return {{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TriangleMesh make_icosphere(int subdivisions) {
  const double g = std::numbers::phi;
  TriangleMesh sphere{{{-1, g, 0},
                       {1, g, 0},
                       {-1, -g, 0},
                       {1, -g, 0},
                       {0, -1, g},
                       {0, 1, g},
                       {0, -1, -g},
                       {0, 1, -g},
                       {g, 0, -1},
                       {g, 0, 1},
                       {-g, 0, -1},
                       {-g, 0, 1}},
                      {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
  for (Vec3& p : sphere.positions) {
    p.normalize();
  }
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [at, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<Index>(sphere.positions.size()));
      if (fresh) {
        sphere.positions.push_back((sphere.positions[a] + sphere.positions[b]).normalized());
      }
      return at->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(4 * sphere.triangles.size());
    for (const Triangle& t : sphere.triangles) {
      const Index ab = middle(t[0], t[1]);
      const Index bc = middle(t[1], t[2]);
      const Index ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
    }
    sphere.triangles = std::move(finer);
  }
  return sphere;
}

TriangleMesh make_torus(double tube, Index around, Index across) {
  TriangleMesh torus;
  for (Index i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (Index j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const double r = 1 + tube * maths::cos(v);
      torus.positions.emplace_back(r * maths::cos(u), r * maths::sin(u), tube * maths::sin(v));
    }
  }
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < across; ++j) {
      const Index a = i * across + j;
      const Index b = ((i + 1) % around) * across + j;
      const Index c = ((i + 1) % around) * across + (j + 1) % across;
      const Index d = i * across + (j + 1) % across;
      torus.triangles.push_back({a, b, c});
      torus.triangles.push_back({a, c, d});
    }
  }
  return torus;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const auto shift = static_cast<Index>(a.positions.size());
  both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) {
    both.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return both;
}

} // namespace cagewright
