#include "symmetry/symmetric_pose.h"

#include <cagewright/mesh/measures.h>

#include <Eigen/SparseCholesky>

#include <array>
#include <utility>

namespace cagewright {
namespace {

/// How much more a vertex and its image are held to be mirror images than edges to keep their
/// shape.
constexpr double likeness = 3;

using Sparse = Eigen::SparseMatrix<double>;

/// Of each vertex how far it can be relied on its image: less where the image of that is another
/// place.
std::vector<double> reliance(const TriangleMesh& surface, const PosedReflection& map) {
  const double unit = diagonal(surface.positions);
  std::vector<Vec3> once;
  for (const SurfacePoint& image : map.images) {
    once.push_back(image.in(surface.positions, surface.triangles));
  }
  std::vector<double> result;
  for (std::size_t v = 0; v < once.size(); ++v) {
    const Vec3 twice = map.images[v].in(once, surface.triangles);
    constexpr double doubtful = 0.02;
    const double off = (twice - surface.positions[v]).norm() / (doubtful * unit);
    result.push_back(1 / (1 + off * off));
  }
  return result;
}

/// The factors for one coordinate: `sign` is 1 where it changes its sign in the mirror.
void factorize(Eigen::SimplicialLDLT<Sparse>& solver, const RigidNet& net,
               const TriangleMesh& surface, const PosedReflection& map,
               const std::vector<double>& trust, double sign) {
  std::vector<Eigen::Triplet<double>> terms;
  net.add_matrix(terms);
  constexpr double hold = 1e-6; // where the whole may be shifted along the plane
  for (std::size_t v = 0; v < trust.size(); ++v) {
    const SurfacePoint& image = map.images[v];
    const Triangle& t = surface.triangles[image.triangle];
    const std::array<std::pair<int, double>, 4> row = {
        std::pair{static_cast<int>(v), 1.0},
        std::pair{static_cast<int>(t[0]), sign * image.weights[0]},
        std::pair{static_cast<int>(t[1]), sign * image.weights[1]},
        std::pair{static_cast<int>(t[2]), sign * image.weights[2]}};
    for (const auto& [a, at_a] : row) {
      for (const auto& [b, at_b] : row) {
        terms.emplace_back(a, b, likeness * trust[v] * at_a * at_b);
      }
    }
    terms.emplace_back(static_cast<int>(v), static_cast<int>(v), hold);
  }
  const auto count = static_cast<Eigen::Index>(trust.size());
  Sparse matrix(count, count);
  matrix.setFromTriplets(terms.begin(), terms.end());
  solver.compute(matrix);
}

} // namespace

std::vector<Vec3> symmetric_pose(const TriangleMesh& surface, const PosedReflection& map,
                                 const MirrorFrame& frame, const Progress& progress) {
  const std::size_t count = surface.positions.size();
  std::vector<Vec3> here;
  for (const Vec3& p : surface.positions) {
    here.push_back(frame.to_frame(p));
  }
  std::vector<Vec3> at;
  for (std::size_t v = 0; v < count; ++v) {
    const Vec3 image = map.images[v].in(here, surface.triangles);
    at.push_back((here[v] + Vec3(-image.x(), image.y(), image.z())) / 2);
  }
  const RigidNet net({here, surface.triangles});
  const std::vector<double> trust = reliance(surface, map);
  std::array<Eigen::SimplicialLDLT<Sparse>, 2> solvers; // of x, and of y and z
  factorize(solvers[0], net, surface, map, trust, 1);
  factorize(solvers[1], net, surface, map, trust, -1);
  constexpr double hold = 1e-6;
  constexpr int rounds = 80;
  for (int round = 0; round < rounds && !progress.cancelled(); ++round) {
    const std::vector<Vec3> pulls = net.pulls(net.turns(at));
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd right(static_cast<Eigen::Index>(count));
      for (std::size_t v = 0; v < count; ++v) {
        right[static_cast<Eigen::Index>(v)] = pulls[v][k] + hold * at[v][k];
      }
      const Eigen::VectorXd solved = solvers[k == 0 ? 0 : 1].solve(right);
      for (std::size_t v = 0; v < count; ++v) {
        at[v][k] = solved[static_cast<Eigen::Index>(v)];
      }
    }
  }
  return at;
}

PoseChange::PoseChange(TriangleMesh from, std::vector<Vec3> to)
    : from_(std::move(from)), to_(std::move(to)), turns_(RigidNet(from_).turns(to_)), tree_(from_) {
}

Vec3 PoseChange::operator()(const Vec3& p) const {
  const NearestPoint nearest = tree_.nearest(p);
  const SurfacePoint point =
      surface_point_of(nearest.point, nearest.triangle, tree_.corners(nearest.triangle));
  const Triangle& t = from_.triangles[nearest.triangle];
  Vec3 result = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Index v = t[static_cast<std::size_t>(k)];
    result += point.weights[static_cast<std::size_t>(k)] *
              (to_[v] + turns_[v] * (p - from_.positions[v]));
  }
  return result;
}

TriangleMesh PoseChange::operator()(TriangleView mesh) const {
  TriangleMesh result;
  result.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  for (const Vec3& p : mesh.positions) {
    result.positions.push_back((*this)(p));
  }
  return result;
}

} // namespace cagewright
