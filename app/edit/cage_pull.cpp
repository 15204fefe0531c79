#include "app/edit/cage_pull.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace cagewright::app {
namespace {

// Of the largest pull: points whose pulls differ by less have contradicting targets.
constexpr double same_pull = 1e-10;

/// What a move costs: the identity, and the stiffness times the graph's Laplacian.
Eigen::SparseMatrix<double> cost_of_moves(const CageGraph& graph, double stiffness) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index row, Index column, double value) {
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    add(v, v, 1);
  }
  for (const auto& [a, b] : graph.edges()) {
    add(a, a, stiffness);
    add(b, b, stiffness);
    add(a, b, -stiffness);
    add(b, a, -stiffness);
  }
  const auto count = static_cast<Eigen::Index>(graph.vertex_count());
  Eigen::SparseMatrix<double> cost(count, count);
  cost.setFromTriplets(entries.begin(), entries.end());
  return cost;
}

} // namespace

CagePull::CagePull(const CageGraph& graph, std::span<const std::vector<double>> weights,
                   double stiffness)
    : weights_(static_cast<Eigen::Index>(weights.size()),
               static_cast<Eigen::Index>(graph.vertex_count())) {
  for (Eigen::Index k = 0; k < weights_.rows(); ++k) {
    weights_.row(k) = Eigen::Map<const Eigen::RowVectorXd>(
        weights[static_cast<std::size_t>(k)].data(), weights_.cols());
  }
  // With Lagrange's multipliers y: cost d = W^T y and W d = lack.
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cost(cost_of_moves(graph, stiffness));
  const Eigen::MatrixXd pulls = cost.solve(Eigen::MatrixXd(weights_.transpose()));
  const Eigen::MatrixXd among = weights_ * pulls;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(same_pull);
  solver.compute(among);
  response_ = pulls * solver.pseudoInverse();
}

std::vector<Vec3> CagePull::pulled(std::span<const Vec3> cage,
                                   std::span<const Vec3> targets) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const auto rows = [](std::span<const Vec3> points) {
    return Eigen::Map<const Rows>(points.empty() ? nullptr : points.front().data(),
                                  static_cast<Eigen::Index>(points.size()), 3);
  };
  const Rows lack = rows(targets) - weights_ * rows(cage);
  const Rows moved = rows(cage) + response_ * lack;
  std::vector<Vec3> positions(cage.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    positions[v] = moved.row(static_cast<Eigen::Index>(v)).transpose();
  }
  return positions;
}

} // namespace cagewright::app
