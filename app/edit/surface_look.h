/// \file
/// What the model looks as if it were made of.
#pragma once

namespace cagewright::app {

enum class SurfaceLook {
  studio,  ///< plain, by soft lights
  clay,    ///< warm and matt: form without gloss
  wax,     ///< light comes through
  metal,   ///< mirrors a sky: bumps show
  stripes, ///< mirrors stripes: kinks of the surface break them
  own,     ///< the colors of its file, by soft lights; plain where it has none
};

} // namespace cagewright::app
