/// \file
/// What is shown of a model that is bound.
#pragma once

#include <cagewright/core/geometry.h>

#include <vector>

namespace cagewright::app {

/// The model as the cage's pose moves it.
struct DeformedModel {
  std::vector<Vec3> positions; ///< V
  std::vector<Vec3> normals;   ///< V, unit
  Box3 box;                    ///< of the positions
};

} // namespace cagewright::app
