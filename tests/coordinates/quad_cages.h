/// \file
/// Cages of quads, some of them far from flat, and points near their bilinear patches.
#pragma once

#include "coordinates/laws.h"

#include <string>
#include <vector>

namespace cagewright::test {

/// The top turned against the bottom: all sides are saddles.
inline PolygonMesh twisted_cube(double angle) {
  PolygonMesh mesh = make_quad_cube();
  for (Vec3& p : mesh.positions) {
    p = Eigen::AngleAxisd(0.5 * angle * p.z(), Vec3::UnitZ()) * p;
  }
  return mesh;
}

/// Triangles and quads: a tent on a cube.
inline PolygonMesh house() {
  const PolygonMesh cube = make_quad_cube();
  PolygonMesh mesh;
  mesh.positions = cube.positions;
  for (std::size_t f = 0; f < 6; ++f) {
    double height = 0;
    for (const Index v : cube.face(f)) {
      height += mesh.positions[v].z() / 4;
    }
    if (height > 0.5) { // the ceiling becomes a tent
      const std::span<const Index> top = cube.face(f);
      const auto tip = static_cast<Index>(mesh.positions.size());
      mesh.positions.emplace_back(0.2, -0.1, 1.8);
      for (std::size_t k = 0; k < 4; ++k) {
        mesh.add_face({top[k], top[(k + 1) % 4], tip});
      }
    } else {
      mesh.add_face(cube.face(f));
    }
  }
  mesh.positions[0] += Vec3(-0.2, 0.1, 0.15);
  return mesh;
}

inline std::vector<LawCage> quad_cages() {
  return {{"Cube", golden_cube()},
          {"Twisted", skewed(twisted_cube(0.9))},
          {"L", make_l()},
          {"House", house()}};
}

/// Inside, and outside up to some diagonals away.
inline std::vector<Vec3> points_round(const PolygonMesh& cage, std::size_t count,
                                      std::uint64_t seed) {
  const Box3 box = bounding_box(cage.positions);
  Random random(seed);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    points.emplace_back(box.center() + (i % 4 == 0 ? 4.0 : 1.0) * offset.cwiseProduct(box.sizes()));
  }
  return points;
}

/// A point of a patch, and its bilinear weights.
struct PatchPoint {
  Vec3 x, normal;
  std::vector<double> weights;
};

/// \param where  0, 1: anywhere; 2: on an edge; 3: at a corner
inline PatchPoint point_of_patch(const PolygonMesh& cage, std::size_t face, int where,
                                 Random& random) {
  const std::span<const Index> corners = cage.face(face);
  const double u = where == 3 ? 0.0 : random.uniform();
  const double v = where >= 2 ? 0.0 : random.uniform();
  const std::array<double, 4> hats = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  PatchPoint point{Vec3::Zero(), Vec3::Zero(), std::vector<double>(cage.positions.size(), 0.0)};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& p = cage.positions[corners[k]];
    point.x += hats[k] * p;
    point.normal +=
        hats[k] *
        (cage.positions[corners[(k + 1) % 4]] - p).cross(cage.positions[corners[(k + 3) % 4]] - p);
    point.weights[corners[k]] += hats[k];
  }
  point.normal.normalize();
  return point;
}

/// The patches as many small triangles, for what need not be exact.
inline TriangleMesh finely_cut(const PolygonMesh& cage) {
  constexpr Index pieces = 24;
  TriangleMesh mesh;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    const std::span<const Index> corners = cage.face(f);
    const auto first = static_cast<Index>(mesh.positions.size());
    if (corners.size() != 4) {
      for (const Index v : corners) {
        mesh.positions.push_back(cage.positions[v]);
      }
      for (Index k = 2; k < corners.size(); ++k) {
        mesh.triangles.push_back({first, first + k - 1, first + k});
      }
      continue;
    }
    for (Index i = 0; i <= pieces; ++i) {
      for (Index k = 0; k <= pieces; ++k) {
        const double u = i / static_cast<double>(pieces);
        const double v = k / static_cast<double>(pieces);
        const std::array<double, 4> hats = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
        Vec3 p = Vec3::Zero();
        for (std::size_t c = 0; c < 4; ++c) {
          p += hats[c] * cage.positions[corners[c]];
        }
        mesh.positions.push_back(p);
        if (i < pieces && k < pieces) {
          const Index here = first + i * (pieces + 1) + k;
          const Index next = here + pieces + 1; // one further along u
          mesh.triangles.push_back({here, next, next + 1});
          mesh.triangles.push_back({here, next + 1, here + 1});
        }
      }
    }
  }
  return mesh;
}

/// Points inside, at a distance in diagonals from the insides of patches; outside if it is
/// negative.
inline std::vector<Vec3> points_by_patches(const PolygonMesh& cage, double distance,
                                           std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::size_t> quads;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    if (cage.face(f).size() == 4) {
      quads.push_back(f);
    }
  }
  const TriangleMesh fine = finely_cut(cage);
  constexpr double far = 5e-3; // where another patch may come between
  std::vector<Vec3> points;
  while (points.size() < count) {
    const PatchPoint on = point_of_patch(cage, quads[random.below(quads.size())], 0, random);
    const Vec3 x = on.x - distance * diagonal(cage.positions) * on.normal;
    if (distance < far || is_inside(fine, x)) {
      points.push_back(x);
    }
  }
  return points;
}

} // namespace cagewright::test
