/// \file
/// Weights times moves: where the points go.
#pragma once

#include <cagewright/coordinates/compact_weights.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <span>

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

/// The same for up to 16 points whose weights Coordinates::solve() has just written, 16 for each
/// column. At least one of them moves.
void move_sixteen(std::span<const double> weights, std::span<const Index> columns,
                  std::span<const Vec3> moves, std::span<const Vec3> base,
                  std::span<Vec3> positions);

} // namespace cagewright
