/// \file
/// Which limbs of a surface are each other's left and right.
#pragma once

#include "symmetry/surface_distances.h"
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace cagewright {

/// The partner of each end of a limb, as a number in their list: itself in the middle.
struct TipPairing {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  std::vector<std::size_t> partners; ///< of each; none: it has none
  /// By how much the distances between the ends differ from those between their partners, over the
  /// sum of the distances; and a little for each end without a partner.
  double cost = 0;
};

/// The pairings under which distances along the surface are about the same, best first: `most` of
/// them at most. Partners are mutual, some two differ, and no pairing is but a part of a better
/// one.
/// Cost: exponential in the number of ends; a dozen are quick.
std::vector<TipPairing> tip_pairings(std::span<const Index> tips, const SurfaceDistances& distances,
                                     std::size_t most);

} // namespace cagewright
