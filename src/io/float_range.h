/// \file
/// Which numbers formats in single precision can hold.
#pragma once

#include <cagewright/core/geometry.h>

#include <limits>

namespace cagewright {

/// Whether floats hold all three coordinates: they are finite, and not too large.
inline bool fits_floats(const Vec3& p) {
  return p.allFinite() &&
         p.cwiseAbs().maxCoeff() <= static_cast<double>(std::numeric_limits<float>::max());
}

} // namespace cagewright
