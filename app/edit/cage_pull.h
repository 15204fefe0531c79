/// \file
/// The model is dragged, and the cage follows it.
#pragma once

#include "app/edit/cage_graph.h"
#include <cagewright/core/geometry.h>

#include <Eigen/Dense>

#include <span>
#include <vector>

namespace cagewright::app {

/// Finds the least change of a cage that brings points of the model where they are wanted.
///
/// A point with weights w lies at the sum of w_c times cage vertex c. Among all moves d of the C
/// cage vertices that bring K points to their targets, the one with the least
///
///     sum over vertices |d_v|^2  +  stiffness * sum over edges |d_a - d_b|^2
///
/// is taken: neighbors go along, what is far away stays. That is a linear map from what the points
/// lack to the moves, made once and applied for each movement of the mouse: three-point editing of
/// a linear system, as in handle-based deformation (Sorkine et al. 2004), with the cage's edges in
/// the place of the mesh's. Where targets contradict each other (one point with two of them), they
/// are met as nearly as they can be.
class CagePull {
public:
  /// How much more it costs that an edge turns than that it moves.
  static constexpr double usual_stiffness = 4;

  CagePull() = default;
  /// \param weights  K rows of C weights
  /// Cost: a sparse factorisation of C x C, and O(C K^2).
  CagePull(const CageGraph& graph, std::span<const std::vector<double>> weights,
           double stiffness = usual_stiffness);

  /// \param cage     C positions from which the change is reckoned
  /// \param targets  K positions
  /// \returns C positions. Cost: O(C K)
  [[nodiscard]] std::vector<Vec3> pulled(std::span<const Vec3> cage,
                                         std::span<const Vec3> targets) const;

private:
  Eigen::MatrixXd weights_;  // K x C
  Eigen::MatrixXd response_; // C x K: the moves for what the points lack
};

} // namespace cagewright::app
