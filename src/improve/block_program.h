/// \file
/// Quadratic programs over the positions of a mesh's vertices.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <span>
#include <vector>

namespace cagewright {

/// One inequality over three or four vertices: the sum of weight_of(i) * direction .
/// x[vertex_of(i)]
/// >= bound.
struct BlockConstraint {
  Triangle vertex{};
  std::array<double, 3> weight{};
  Vec3 direction = Vec3::Zero();
  double bound = 0;
  Index fourth_vertex = 0;
  double fourth_weight = 0; ///< 0: there are three

  [[nodiscard]] int size() const { return fourth_weight != 0 ? 4 : 3; }
  [[nodiscard]] Index vertex_of(int i) const { return i < 3 ? vertex[i] : fourth_vertex; }
  [[nodiscard]] double weight_of(int i) const { return i < 3 ? weight[i] : fourth_weight; }
};

/// A quadratic function of N points: 1/2 x.H x + g.x. H is made of 3 x 3 blocks, of which those
/// that join the corners of one face may be other than zero; it must be positive definite.
struct BlockQuadratic {
  explicit BlockQuadratic(std::size_t count) : gradient(count, Vec3::Zero()) {}

  struct Term { ///< adds to the block (row, column), and its transpose to (column, row)
    Index row, column;
    Mat3 block;
  };
  std::vector<Vec3> gradient; ///< N
  std::vector<Term> terms;    ///< row = column: added once
};

struct BlockProgramOptions {
  double slack = 1e-6; ///< by so many times its multiplier a constraint may be missed
  /// How far the quadratic, and what the slack costs, may be from their least: a share of their
  /// size.
  double accuracy = 0.02;
};

/// The points that minimise the quadratic under the constraints, by a primal-dual interior point
/// method (Mehrotra's predictor and corrector; Nocedal and Wright, "Numerical Optimization", 16.6).
/// The slack sees to it that there always is a solution. The start is x = 0; that is also the
/// answer if the method does not converge, which happens when the constraints contradict each other
/// by far more than the slack; and if the computation is to stop.
///
/// Constraints over the same vertices in the same direction cost least if they follow each other.
/// Cost: some 10 sparse factorisations of a 3N x 3N matrix.
std::vector<Vec3> minimize(const BlockQuadratic& quadratic,
                           std::span<const BlockConstraint> constraints,
                           const BlockProgramOptions& options = {}, const Progress& progress = {});

} // namespace cagewright
