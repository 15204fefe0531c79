#include "symmetry/rigid_net.h"

#include "core/parallel.h"

#include <Eigen/SVD>

#include <algorithm>
#include <map>
#include <utility>

namespace cagewright {
namespace {

/// Cotangents may be negative or huge: a net needs weights that are neither.
constexpr double least_weight = 0.05;
constexpr double most_weight = 5;

double cotangent(const Vec3& u, const Vec3& v) {
  const double sine = u.cross(v).norm();
  return sine > 0 ? u.dot(v) / sine : 0;
}

Mat3 nearest_turn(const Mat3& covariance) {
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 v = svd.matrixV();
  const Mat3 turn = svd.matrixU() * v.transpose();
  if (turn.determinant() < 0) {
    v.col(2) *= -1;
    return svd.matrixU() * v.transpose();
  }
  return turn;
}

} // namespace

RigidNet::RigidNet(TriangleView rest)
    : rest_(rest.positions.begin(), rest.positions.end()), edges_at_(rest.positions.size()) {
  std::map<std::pair<Index, Index>, double> weights;
  for (const Triangle& t : rest.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[(k + 1) % 3];
      const Vec3& c = rest_[t[(k + 2) % 3]];
      weights[std::minmax(a, b)] += cotangent(rest_[a] - c, rest_[b] - c) / 2;
    }
  }
  for (const auto& [ends, weight] : weights) {
    edges_at_[ends.first].push_back(static_cast<Index>(edges_.size()));
    edges_at_[ends.second].push_back(static_cast<Index>(edges_.size()));
    edges_.push_back({ends.first, ends.second, std::clamp(weight, least_weight, most_weight)});
  }
}

std::vector<Mat3> RigidNet::turns(std::span<const Vec3> at) const {
  std::vector<Mat3> result(size(), Mat3::Identity());
  parallel_for(0, size(), 64, [&](std::size_t v) {
    Mat3 covariance = Mat3::Zero();
    for (const Index e : edges_at_[v]) {
      const Edge& edge = edges_[e];
      covariance +=
          edge.weight * (at[edge.a] - at[edge.b]) * (rest_[edge.a] - rest_[edge.b]).transpose();
    }
    result[v] = nearest_turn(covariance);
  });
  return result;
}

std::vector<Vec3> RigidNet::pulls(std::span<const Mat3> turns) const {
  std::vector<Vec3> result(size(), Vec3::Zero());
  for (const Edge& edge : edges_) {
    const Vec3 pull =
        edge.weight / 2 * (turns[edge.a] + turns[edge.b]) * (rest_[edge.a] - rest_[edge.b]);
    result[edge.a] += pull;
    result[edge.b] -= pull;
  }
  return result;
}

void RigidNet::add_matrix(std::vector<Eigen::Triplet<double>>& terms) const {
  for (const Edge& edge : edges_) {
    const int a = static_cast<int>(edge.a);
    const int b = static_cast<int>(edge.b);
    terms.emplace_back(a, a, edge.weight);
    terms.emplace_back(b, b, edge.weight);
    terms.emplace_back(a, b, -edge.weight);
    terms.emplace_back(b, a, -edge.weight);
  }
}

} // namespace cagewright
