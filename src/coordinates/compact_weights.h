/// \file
/// Weights in half the memory, with a proven bound on what that costs.
#pragma once

#include "coordinates/weights.h"
#include "core/geometry.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// Weights as 16-bit multiples of a step, one for each cage vertex:
/// weight(p, c) = tiles.at(p, c) * steps[c].
///
/// Meant for displacements (rest position + sum of weight times displacement), where a cage at rest
/// leaves the model exactly where it is. Half-precision floats would take the same memory, and err
/// eight times as much on the weights that matter, the large ones.
struct CompactWeights {
  WeightTiles<std::int16_t> tiles;
  std::vector<double> steps; ///< C

  [[nodiscard]] std::size_t points() const { return tiles.points(); }
  [[nodiscard]] std::size_t cage_vertices() const { return tiles.cage_vertices(); }
};

/// Rounds the weights: the step of a cage vertex is its largest weight / 32767, so every weight
/// changes by half a step at most.
CompactWeights make_compact(const FloatWeights& weights);

/// No point is moved by these displacements (C) farther than this from where the original weights
/// would have moved it: the sum of half a step times the length of the displacement.
double position_error_bound(const CompactWeights& weights, std::span<const Vec3> displacements);

} // namespace cagewright
