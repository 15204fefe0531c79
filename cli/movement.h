/// \file
/// One file for all frames of a sequence: point caches and animated GLB.
#pragma once

#include "session.h"

#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/point_cache.h>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright::cli {

/// Moves the model as the cage moves from its rest to each of some poses: for each all P positions.
/// It may be called again and again, for so many poses at a time as memory allows.
using Mover =
    std::function<Result<std::vector<std::vector<Vec3>>>(std::span<const std::vector<Vec3>>)>;

/// Is shown the P positions of the model at each frame, in their order.
using FrameSeen = std::function<void(std::size_t frame, std::span<const Vec3> positions)>;

/// Declares --fps and --first-frame.
void add_time_options(CLI::App& command, FrameTimes& times);

/// Whether all poses go into this one file: a point cache, or, where there are several, a GLB.
bool holds_movement(const std::string& output, std::size_t poses);

/// Whether one name comes before another where numbers count as numbers: frame_9 before frame_10.
bool comes_before(std::string_view one, std::string_view other);

/// Frames as a shell lists them, frame_10 before frame_9, are put into the order of their numbers,
/// and that is said. A list in an order of the caller's own, such as there and back, stays.
void in_order_of_frames(std::vector<std::string>& names);

/// Writes the model as it moves: a frame for each pose of the cage, of C positions each.
/// Errors: those of write_animation(), PointCacheWriter and of moving.
Status write_movement(const ModelFile& file, std::span<const std::vector<Vec3>> cages,
                      const Mover& move, const FrameTimes& times, const std::string& output,
                      const FrameSeen& seen, const Session& session);

} // namespace cagewright::cli
