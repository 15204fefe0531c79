/// \file
/// What the shapes of its faces make a cage of quads dearer by.
#pragma once

#include "mesh/shape_limits.h"
#include <cagewright/quads/quad_report.h>

#include <algorithm>

namespace cagewright {

/// \param thin  share of the triangles
inline double dearer_by_thin(double thin, double for_thin = 2) {
  return 1 + for_thin * std::max(0.0, thin - shape_limits::few_thin);
}

/// 1 if as many faces are quads as are wanted, few triangles are thin, and none is a needle.
///
/// \param wanted  share of the faces
inline double dearer_by_shapes(const QuadReport& report, double wanted) {
  constexpr double for_too_few = 0.1; // quads were asked for, but not at any price
  constexpr double for_each_less = 3;
  constexpr double for_needles = 0.1;
  constexpr double for_thin = 1; // as thin limbs have them, between quads as they should be
  return dearer_by_thin(report.thin, for_thin) +
         (report.share < shape_limits::enough_quads ? for_too_few : 0) +
         for_each_less * std::max(0.0, wanted - report.share) +
         (report.least_quality < shape_limits::needle ? for_needles : 0);
}

} // namespace cagewright
