/// \file
/// A model that follows its cage through a sequence of poses, in one file.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/point_cache.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace cagewright {

/// Moves a model of P vertices as its cage moves from its rest to each of some poses of C
/// positions: for each pose P positions. It may be called again and again, for so many poses at a
/// time as memory allows.
using Mover =
    std::function<Result<std::vector<std::vector<Vec3>>>(std::span<const std::vector<Vec3>>)>;

/// Is shown the P positions of the model at each frame, in their order.
using FrameSeen = std::function<void(std::size_t frame, std::span<const Vec3> positions)>;

/// Whether a file of this name holds the movement through so many poses, and not just one of them:
/// a point cache, or, where there are several poses, a GLB.
bool holds_movement(const std::filesystem::path& output, std::size_t poses);

/// Writes a model as it moves: a frame for each pose of its cage. What the formats are is told by
/// PointCacheWriter (.pc2, .mdd) and write_animation() (.glb: each frame is a morph target).
///
/// \param file    the model at rest, P vertices
/// \param cages   F poses of C positions each
/// \param output  a name that holds_movement()
/// \returns notes about what the file cannot hold
///
/// Errors: those of PointCacheWriter, write_animation() and of moving; cancelled.
/// Cost: that of moving; point caches need the memory of as many frames as fit into a quarter of a
/// gigabyte, GLB that of all.
Result<std::vector<FileNote>>
write_movement(const ModelFile& file, std::span<const std::vector<Vec3>> cages, const Mover& move,
               const FrameTimes& times, const std::filesystem::path& output,
               const Progress& progress = {}, const FrameSeen& seen = {});

} // namespace cagewright
