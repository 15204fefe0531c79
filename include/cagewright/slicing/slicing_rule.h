/// \file
/// How a box chooses where it is cut in two.
#pragma once

namespace cagewright {

/// How a box chooses where to cut.
enum class SlicingRule {
  volume,    ///< where the boxes of the resulting connected parts have the least volume
  published, ///< at the greatest jump of the cross-section function (Xian, Lin and Gao 2012)
};

/// What the published rule does with a box in which no axis has a clear jump of f.
enum class NoJump {
  skip,   ///< leave the box whole
  middle, ///< cut through the middle of its longest edge
};

} // namespace cagewright
