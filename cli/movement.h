/// \file
/// Sequences on the command line: in which order, at what times, into how many files.
#pragma once

#include "session.h"

#include <cagewright/io/point_cache.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright::cli {

/// Declares --fps and --first-frame.
void add_time_options(CLI::App& command, FrameTimes& times);

/// Whether all poses go into this one file, see holds_movement(): not into a folder, nor into files
/// with a name for each in place of *.
bool is_one_movement(const std::string& output, std::size_t poses);

/// Whether one name comes before another where numbers count as numbers: frame_9 before frame_10.
bool comes_before(std::string_view one, std::string_view other);

/// Frames as a shell lists them, frame_10 before frame_9, are put into the order of their numbers,
/// and that is said. A list in an order of the caller's own, such as there and back, stays.
void in_order_of_frames(std::vector<std::string>& names);

} // namespace cagewright::cli
