/// \file
/// What must hold for every kind of coordinates, on cages of many shapes.
#pragma once

#include "coordinates/points_near.h"
#include "coordinates/reference.h"
#include "core/random.h"
#include "mesh/shapes.h"
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <numeric>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::test {

struct LawCage {
  std::string name;
  PolygonMesh mesh;

  friend void PrintTo(const LawCage& cage, std::ostream* out) { *out << cage.name; }
};

/// The unit cube of section "golden values": vertex i at (i & 1, i >> 1 & 1, i >> 2 & 1).
inline PolygonMesh golden_cube() {
  PolygonMesh cube;
  for (unsigned i = 0; i < 8; ++i) {
    cube.positions.emplace_back(i & 1U, i >> 1U & 1U, i >> 2U & 1U);
  }
  for (const auto& quad : std::initializer_list<std::initializer_list<Index>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}) {
    cube.add_face(quad);
  }
  return cube;
}
inline Vec3 golden_point() {
  return {0.3, 0.4, 0.2};
}

/// Its top turned by 0.5 about the middle, widened by 1.3 and lifted to 1.2.
inline std::vector<Vec3> golden_pose() {
  std::vector<Vec3> pose = golden_cube().positions;
  for (Vec3& p : pose) {
    if (p.z() > 0.5) {
      const Vec3 side = 1.3 * (p - Vec3(0.5, 0.5, 1));
      p = Vec3(0.5, 0.5, 1.2) + Eigen::AngleAxisd(0.5, Vec3::UnitZ()) * side;
    }
  }
  return pose;
}

/// An L of quads: six prisms of unit cubes side by side, its long arm along x.
inline PolygonMesh make_l() {
  PolygonMesh mesh;
  const std::vector<std::pair<double, double>> outline = {{0, 0}, {2, 0}, {2, 1},
                                                          {1, 1}, {1, 2}, {0, 2}};
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : outline) {
      mesh.positions.emplace_back(x, y, z);
    }
  }
  for (Index i = 0; i < 6; ++i) {
    const Index next = (i + 1) % 6;
    mesh.add_face({i, next, next + 6, i + 6});
  }
  mesh.add_face({0, 3, 2, 1});
  mesh.add_face({0, 5, 4, 3});
  mesh.add_face({6, 7, 8, 9});
  mesh.add_face({6, 9, 10, 11});
  return mesh;
}

/// An octahedron of which every face is drawn out to a spike: concave along all edges.
inline PolygonMesh make_star() {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      mesh.positions.emplace_back(0.5 * side * Vec3::Unit(axis));
    }
  }
  for (Index octant = 0; octant < 8; ++octant) {
    const Index x = octant & 1U;
    const Index y = 2 + (octant >> 1U & 1U);
    const Index z = 4 + (octant >> 2U & 1U);
    const bool odd = ((octant & 1U) + (octant >> 1U & 1U) + (octant >> 2U & 1U)) % 2 == 1;
    const auto tip = static_cast<Index>(mesh.positions.size());
    mesh.positions.emplace_back(0.9 * (mesh.positions[x] + mesh.positions[y] + mesh.positions[z]));
    const std::array<Index, 3> base = odd ? std::array{x, z, y} : std::array{x, y, z};
    for (std::size_t i = 0; i < 3; ++i) {
      mesh.triangles.push_back({base[i], base[(i + 1) % 3], tip});
    }
  }
  return PolygonMesh(mesh);
}

/// So that no plane or line of the cage is aligned with the axes.
inline PolygonMesh skewed(PolygonMesh mesh) {
  for (Vec3& p : mesh.positions) {
    p = Vec3(1.1 * p.x() + 0.1, 0.9 * p.y() + 0.03 * p.x(), p.z() + 0.02 * p.y());
  }
  return mesh;
}

inline std::vector<LawCage> law_cages() {
  return {{"Cube", PolygonMesh(make_cube())},
          {"QuadCube", skewed(make_quad_cube())},
          {"L", make_l()},
          {"Star", make_star()},
          {"Tetrahedron", skewed(PolygonMesh(make_tetrahedron()))},
          {"Torus", skewed(PolygonMesh(make_torus(0.35, 8, 5)))}};
}

/// The sum of solid angles over 4 pi: 1 inside.
inline double winding(TriangleView cage, const Vec3& x) {
  using Real = long double;
  Real sum = 0;
  for (const Triangle& t : cage.triangles) {
    std::array<Eigen::Matrix<Real, 3, 1>, 3> p;
    std::array<Real, 3> d;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = cage.positions[t[i]].cast<Real>() - x.cast<Real>();
      d[i] = p[i].norm();
    }
    sum += 2 * std::atan2(p[0].dot(p[1].cross(p[2])), d[0] * d[1] * d[2] + p[0].dot(p[1]) * d[2] +
                                                          p[1].dot(p[2]) * d[0] +
                                                          p[2].dot(p[0]) * d[1]);
  }
  return static_cast<double>(sum / (4 * std::numbers::pi_v<Real>));
}

inline bool is_inside(TriangleView cage, const Vec3& x) {
  return std::abs(winding(cage, x) - 1) < 1e-5;
}

/// Random points inside, anywhere.
inline std::vector<Vec3> points_inside(const PolygonMesh& cage, std::size_t count,
                                       std::uint64_t seed) {
  const TriangleMesh mesh = to_triangle_mesh(cage);
  const Box3 box = bounding_box(mesh.positions);
  Random random(seed);
  std::vector<Vec3> points;
  while (points.size() < count) {
    const Vec3 offset(random.uniform(), random.uniform(), random.uniform());
    const Vec3 x = box.min() + offset.cwiseProduct(box.sizes());
    if (is_inside(mesh, x)) {
      points.push_back(x);
    }
  }
  return points;
}

inline constexpr std::array all_sites = {Site::face, Site::edge,   Site::vertex,   Site::plane,
                                         Site::line, Site::beside, Site::at_corner};

/// Points inside at a distance, in diagonals, from elements of the cage.
inline std::vector<Vec3> points_inside_near(const PolygonMesh& cage, double distance,
                                            std::size_t count, std::uint64_t seed) {
  const TriangleMesh mesh = to_triangle_mesh(cage);
  const double unit = diagonal(mesh.positions);
  Random random(seed);
  std::vector<Vec3> points;
  for (std::size_t tries = 0; points.size() < count && tries < 400 * count; ++tries) {
    const Vec3 x =
        point_near(mesh, all_sites[random.below(all_sites.size())], distance * unit, random);
    if (is_inside(mesh, x)) {
      points.push_back(x);
    }
  }
  return points;
}

struct Solved {
  std::vector<double> weights;
  TileReport report;
};

inline Solved solve(const Coordinates& coordinates, const Vec3& x) {
  const std::size_t columns = coordinates.columns();
  std::vector<double> tile(16 * columns);
  Solved solved;
  solved.report = coordinates.solve(std::span(&x, 1), tile);
  for (std::size_t k = 0; k < columns; ++k) {
    solved.weights.push_back(tile[16 * k]);
  }
  return solved;
}

inline double largest(const std::vector<double>& weights) {
  double most = 0;
  for (const double w : weights) {
    most = std::max(most, std::abs(w));
  }
  return most;
}

/// The greatest difference, relative to the largest weight.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    worst = std::max(worst, std::abs(a[k] - b[k]));
  }
  return a.size() == b.size() ? worst / largest(b) : 1e300;
}

inline Vec3 reproduced(const std::vector<double>& weights, std::span<const Vec3> from) {
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    x += weights[k] * from[k];
  }
  return x;
}

inline double sum_over_vertices(const Coordinates& coordinates,
                                const std::vector<double>& weights) {
  const auto count = static_cast<std::ptrdiff_t>(coordinates.rule()->cage_at_rest().size());
  return std::accumulate(weights.begin(), weights.begin() + count, 0.0);
}

/// Where a point goes when the cage does.
inline Vec3 moved(const Coordinates& coordinates, const Vec3& x, std::span<const Vec3> pose) {
  std::vector<Vec3> moves(coordinates.columns());
  coordinates.rule()->move(pose, moves);
  return x + reproduced(solve(coordinates, x).weights, moves);
}

using Made = Result<std::shared_ptr<const Coordinates>>;
using Make = std::function<Made(const PolygonMesh&)>;

struct Similarity {
  double scale;
  Eigen::Matrix3d turn;
  Vec3 shift;

  Vec3 operator()(const Vec3& p) const { return scale * (turn * p) + shift; }
};

inline Similarity some_similarity(double scale) {
  return {scale, Eigen::AngleAxisd(2.2, Vec3(1, 2, -0.5).normalized()).toRotationMatrix(),
          scale * Vec3(0.3, -1, 0.7)};
}

/// Sums are one, and points are reproduced.
inline void expect_partition_and_reproduction(const Coordinates& coordinates, const Vec3& x,
                                              double unit, double tolerance) {
  const Solved solved = solve(coordinates, x);
  EXPECT_EQ(solved.report.undefined, 0) << x.transpose();
  EXPECT_EQ(solved.report.outside, 0) << x.transpose();
  const double most = std::max(1.0, largest(solved.weights));
  EXPECT_NEAR(sum_over_vertices(coordinates, solved.weights), 1, 0.1 * tolerance * most)
      << x.transpose();
  const std::vector<Vec3> from = coordinates.rule()->reproduced_from();
  EXPECT_LT((reproduced(solved.weights, from) - x).norm(), tolerance * most * unit)
      << x.transpose();
}

/// A similarity of the cage, half turns included, does the same to the model.
inline void expect_similarities_follow(const Coordinates& coordinates,
                                       const std::vector<Vec3>& points, double unit,
                                       double tolerance) {
  for (const double scale : {0.4, 1.0, 3.0}) {
    const Similarity map = some_similarity(scale);
    std::vector<Vec3> pose;
    for (const Vec3& c : coordinates.rule()->cage_at_rest()) {
      pose.push_back(map(c));
    }
    for (const Vec3& x : points) {
      EXPECT_LT((moved(coordinates, x, pose) - map(x)).norm(), tolerance * scale * unit)
          << x.transpose();
    }
  }
}

inline double map_scale(const Similarity& map) {
  return 1 / map.scale;
}
template <class Map> double map_scale(const Map&) {
  return 1;
}

/// The weights do not depend on unit, place and direction, on the order of faces and corners, or on
/// which way out the cage is turned; mirrored cages have mirrored weights.
/// Columns behind those of vertices follow the order of faces, and are compared where it is kept.
inline void expect_invariance(const Make& make, const PolygonMesh& cage,
                              const std::vector<Vec3>& points, double tolerance) {
  const Made plain = make(cage);
  ASSERT_TRUE(plain) << plain.error().message;
  const auto same = [&](const PolygonMesh& other, const auto& map, bool all_columns,
                        const char* what) {
    const Made made = make(other);
    ASSERT_TRUE(made) << what << ": " << made.error().message;
    // Normals are in units of the box's diagonal, which turns do change: by what they reproduce.
    const std::vector<Vec3> before = (*plain)->rule()->reproduced_from();
    const std::vector<Vec3> after = (*made)->rule()->reproduced_from();
    for (const Vec3& x : points) {
      std::vector<double> expected = solve(**plain, x).weights;
      std::vector<double> found = solve(**made, map(x)).weights;
      const std::size_t vertices = cage.positions.size();
      for (std::size_t k = vertices; all_columns && k < found.size(); ++k) {
        found[k] *= after[k].norm() * map_scale(map) / before[k].norm();
      }
      if (!all_columns) {
        expected.resize(vertices);
        found.resize(vertices);
      }
      EXPECT_LT(relative_difference(found, expected), tolerance) << what << ", " << x.transpose();
    }
  };
  const auto identity = [](const Vec3& p) { return p; };
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Similarity map = some_similarity(scale);
    PolygonMesh other = cage;
    for (Vec3& p : other.positions) {
      p = map(p);
    }
    same(other, map, true, "similarity");
  }
  PolygonMesh shuffled; // faces in another order, begun at other corners
  PolygonMesh turned;   // inside out
  PolygonMesh mirrored;
  shuffled.positions = turned.positions = mirrored.positions = cage.positions;
  const auto mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
  for (Vec3& p : mirrored.positions) {
    p = mirror(p);
  }
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    const std::span<const Index> last = cage.face(cage.face_count() - 1 - f);
    std::vector<Index> corners(last.begin(), last.end());
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(f % corners.size()),
                corners.end());
    shuffled.add_face(corners);
    std::vector<Index> reversed(cage.face(f).begin(), cage.face(f).end());
    std::ranges::reverse(reversed);
    turned.add_face(reversed);
    mirrored.add_face(reversed);
  }
  same(shuffled, identity, false, "order of faces");
  same(turned, identity, false, "inside out");
  same(mirrored, mirror, false, "mirrored");
}

/// An affine map of the cage does the same to the model.
inline void expect_affine_maps_follow(const Coordinates& coordinates,
                                      const std::vector<Vec3>& points, double unit,
                                      double tolerance) {
  Eigen::Matrix3d map;
  map << 1.1, 0.2, 0, -0.3, 0.9, 0.1, 0.05, 0, 1.3;
  const Vec3 shift(0.5, -1, 0.25);
  std::vector<Vec3> pose;
  for (const Vec3& c : coordinates.rule()->cage_at_rest()) {
    pose.emplace_back(map * c + shift);
  }
  for (const Vec3& x : points) {
    EXPECT_LT((moved(coordinates, x, pose) - (map * x + shift)).norm(), tolerance * unit)
        << x.transpose();
  }
}

/// Points of the surface inside a triangle of `mesh`, on an edge and at a vertex of it, with what
/// they weigh.
struct OnCage {
  Vec3 x;
  std::vector<double> weights;
};
inline std::vector<OnCage> points_on(const TriangleMesh& mesh, std::size_t count,
                                     std::uint64_t seed) {
  Random random(seed);
  std::vector<OnCage> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[random.below(mesh.triangles.size())];
    std::array<double, 3> share = {1, 0, 0};
    if (i % 3 != 2) {
      share = {random.uniform(), random.uniform(), i % 3 == 0 ? random.uniform() : 0.0};
    }
    const double sum = share[0] + share[1] + share[2];
    OnCage on{Vec3::Zero(), std::vector<double>(mesh.positions.size(), 0.0)};
    for (std::size_t k = 0; k < 3; ++k) {
      on.x += share[k] / sum * mesh.positions[t[k]];
      on.weights[t[k]] += share[k] / sum;
    }
    points.push_back(std::move(on));
  }
  return points;
}

/// On the cage they are the barycentric coordinates, and near it they come there.
/// \param mesh  the cage, of triangles alone
/// \param rate  at distance d from the cage the weights may differ by rate * d ln(1 / d)
inline void expect_interpolation(const Coordinates& coordinates, const TriangleMesh& mesh,
                                 double rate) {
  const double unit = diagonal(mesh.positions);
  Random random(31);
  for (const OnCage& on : points_on(mesh, 45, 32)) {
    const Solved here = solve(coordinates, on.x);
    EXPECT_EQ(here.report.on_surface, 1) << on.x.transpose();
    EXPECT_LT(relative_difference(here.weights, on.weights), 1e-12) << on.x.transpose();
    for (const double distance : {1e-3, 1e-5, 1e-7, 1e-8, 3e-9, 1e-10, 1e-11, 1e-12}) {
      for (int tries = 0; tries < 20; ++tries) {
        const Vec3 near = on.x + distance * unit * random_direction(random);
        if (is_inside(mesh, near)) {
          EXPECT_LT(relative_difference(solve(coordinates, near).weights, on.weights),
                    rate * distance * std::log(1 / distance) + 1e-12)
              << distance << ": " << on.x.transpose();
          break;
        }
      }
    }
  }
}

/// In a tetrahedron all interpolating kinds are the barycentric coordinates.
inline void expect_barycentric_in_a_tetrahedron(const Make& make, double tolerance) {
  const PolygonMesh cage = skewed(PolygonMesh(make_tetrahedron()));
  const Made made = make(cage);
  ASSERT_TRUE(made) << made.error().message;
  Eigen::Matrix4d corners;
  for (int i = 0; i < 4; ++i) {
    corners.col(i) << cage.positions[static_cast<std::size_t>(i)], 1;
  }
  std::vector<Vec3> points = points_inside(cage, 30, 33);
  for (const double distance : {1e-3, 1e-5, 1e-7}) {
    const std::vector<Vec3> near = points_inside_near(cage, distance, 10, 34);
    points.insert(points.end(), near.begin(), near.end());
  }
  for (const Vec3& x : points) {
    const Eigen::Vector4d expected =
        corners.partialPivLu().solve(Eigen::Vector4d(x.x(), x.y(), x.z(), 1));
    const std::vector<double> found = solve(**made, x).weights;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(found[i], expected[static_cast<Eigen::Index>(i)], tolerance) << x.transpose();
    }
  }
}

/// The numbers are the same with each instruction set of this machine.
inline void expect_alike_on_all_targets(const Coordinates& coordinates,
                                        const std::vector<Vec3>& points, double tolerance) {
  std::vector<std::vector<double>> expected;
  for (const Vec3& x : points) {
    expected.push_back(solve(coordinates, x).weights);
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT(relative_difference(solve(coordinates, points[i]).weights, expected[i]), tolerance)
          << hwy::TargetName(target) << ": " << points[i].transpose();
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

} // namespace cagewright::test
