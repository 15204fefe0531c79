/// \file
/// The cage between keyframes.
#pragma once

#include "app/document/state.h"

#include <vector>

namespace cagewright::app {

/// C positions at a frame, which need not be whole: on a smooth curve through the keyframes
/// (Catmull-Rom for uneven distances, in time), standing still before and after them. One keyframe
/// holds for ever. Empty without keyframes.
std::vector<Vec3> cage_at(const TimeLine& time_line, double frame);

/// How much each keyframe counts at a frame: C positions, or any numbers that the keyframes hold,
/// are the sum of so much of each. Empty without keyframes.
std::vector<double> key_shares(const TimeLine& time_line, double frame);

/// How much of each of so many poses is in the cage at a frame.
std::vector<double> pose_shares_at(const TimeLine& time_line, double frame, std::size_t poses);

/// The time line with a keyframe added, or replaced where the frame has one.
TimeLine with_keyframe(TimeLine time_line, Keyframe key);

/// The same without the keyframe of that frame.
TimeLine without_keyframe(TimeLine time_line, int frame);

} // namespace cagewright::app
