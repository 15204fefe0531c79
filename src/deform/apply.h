/// \file
/// Weights times moves: where the points go.
#pragma once

#include <cagewright/coordinates/columns.h>
#include <cagewright/coordinates/compact_weights.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace cagewright {

/// Moves points by those of n columns, such as the moves of vertices of the cage:
///     positions[p] = base[p] + sum over k of weight(p, columns[k]) * moves[k],
/// in double whatever the weights are stored as. `base` is the rest for a pose from scratch, or
/// `positions` itself to go on from where they are.
///
/// \param columns  n indices < K
/// \param moves    n vectors
/// \param moved    empty, or for each 16 points the greatest change of a coordinate so far:
///                 this call's is added
///
/// On all cores of the calling arena; the result does not depend on their number. No memory is
/// taken. Cost: bounded by reading n P weights, and the positions once.
template <class T>
void move_points(const WeightTiles<T>& weights, std::span<const Index> columns,
                 std::span<const Vec3> moves, std::span<const Vec3> base, std::span<Vec3> positions,
                 std::span<double> moved = {});

extern template void move_points(const WeightTiles<double>&, std::span<const Index>,
                                 std::span<const Vec3>, std::span<const Vec3>, std::span<Vec3>,
                                 std::span<double>);
extern template void move_points(const WeightTiles<float>&, std::span<const Index>,
                                 std::span<const Vec3>, std::span<const Vec3>, std::span<Vec3>,
                                 std::span<double>);

/// The same with compact weights.
void move_points(const CompactWeights& weights, std::span<const Index> columns,
                 std::span<const Vec3> moves, std::span<const Vec3> base, std::span<Vec3> positions,
                 std::span<double> moved = {});

/// A pose of the cage, as the columns see it.
struct PosedColumns {
  std::vector<Index> columns; ///< all of them
  std::vector<Vec3> moves;
  std::optional<ColumnDivisor> divisor;

  PosedColumns(const ColumnRule& rule, std::span<const Vec3> cage);
};

/// Divides points that were moved by all columns (see ColumnDivisor).
/// \param by  for each point the three columns of A
void divide_points(const Vec3& center, const std::array<std::span<const Vec3>, 3>& by,
                   std::span<Vec3> positions);

/// Moves points from their rest to a pose. W is WeightTiles of double or float, or CompactWeights.
template <class W>
void move_to_pose(const W& weights, const PosedColumns& pose, std::span<const Vec3> rest,
                  std::span<Vec3> positions) {
  move_points(weights, pose.columns, pose.moves, rest, positions);
  if (pose.divisor) {
    std::array<std::vector<Vec3>, 3> by;
    for (std::size_t a = 0; a < 3; ++a) {
      by[a].assign(rest.size(), Vec3::Zero());
      move_points(weights, pose.columns, pose.divisor->moves[a], by[a], by[a]);
    }
    divide_points(pose.divisor->center, {by[0], by[1], by[2]}, positions);
  }
}

/// The same for up to 16 points whose weights Coordinates::solve() has just written, 16 for each
/// column.
void move_sixteen(std::span<const double> weights, const PosedColumns& pose,
                  std::span<const Vec3> rest, std::span<Vec3> positions);

} // namespace cagewright
