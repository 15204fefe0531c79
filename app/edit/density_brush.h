/// \file
/// Painting where the cage is to be finer.
#pragma once

#include <cagewright/core/geometry.h>

#include <span>
#include <vector>

namespace cagewright::app {

/// One touch of the brush.
struct Dab {
  Vec3 place = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ(); ///< of the surface there: what looks the other way is left alone
  double radius = 0;           ///< in the model's unit
  double amount = 0;           ///< added in the middle, less towards the rim; negative: coarser
  bool erases = false;         ///< draws towards 0 instead, by `amount`
};

/// Adds dabs, one after the other, to what is painted, one number for each of V vertices; it stays
/// within [least, 1]. Cost: O(V), on all cores.
/// \param normals  V, unit
void paint_dabs(std::span<const Dab> dabs, std::span<const Vec3> positions,
                std::span<const Vec3> normals, std::vector<float>& painted, float least = -1);

} // namespace cagewright::app
