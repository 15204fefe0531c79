/// \file
/// A surface that bends, but keeps its shape nearby.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <Eigen/SparseCore>

#include <array>
#include <span>
#include <vector>

namespace cagewright {

/// The edges of a surface as they are at rest, each with a weight. What it costs to bend them is
/// the sum of weight |(x_a - x_b) - R (p_a - p_b)|^2, with R the turn of the surface round each of
/// the two ends, in the mean.
///
/// Sorkine and Alexa, "As-rigid-as-possible surface modeling", 2007.
class RigidNet {
public:
  /// \param rest  its positions are copied
  explicit RigidNet(TriangleView rest);

  [[nodiscard]] std::size_t size() const { return rest_.size(); }
  [[nodiscard]] const std::vector<Vec3>& rest() const { return rest_; }

  /// The turn of each vertex's edges from rest that fits best, V.
  [[nodiscard]] std::vector<Mat3> turns(std::span<const Vec3> at) const;

  /// What the edges pull each vertex to: the right-hand side that goes with add_matrix(), V.
  [[nodiscard]] std::vector<Vec3> pulls(std::span<const Mat3> turns) const;

  /// Adds the matrix of one coordinate, V x V: both triangles of it.
  void add_matrix(std::vector<Eigen::Triplet<double>>& terms) const;

private:
  struct Edge {
    Index a = 0;
    Index b = 0;
    double weight = 0;
  };
  std::vector<Vec3> rest_;
  std::vector<Edge> edges_;
  std::vector<std::vector<Index>> edges_at_;
};

} // namespace cagewright
