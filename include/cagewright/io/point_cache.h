/// \file
/// Point caches: where the vertices of a mesh are at each frame, PC2 and MDD.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace cagewright {

/// When the frames of a sequence are.
struct FrameTimes {
  double first_frame = 1; ///< the number of the first of them
  double frames_per_second = 24;
};

/// Whether the extension is that of a point cache: .pc2 or .mdd, in letters of either case.
bool is_point_cache(const std::filesystem::path& path);

/// A point cache that is written frame by frame, so that a sequence of any length needs the memory
/// of one frame.
///  - .pc2: "Point Cache 2", as read by Blender, 3ds Max, Houdini: V positions of three floats a
///    frame, little endian.
///  - .mdd: LightWave's point cache, likewise with the time of each frame, big endian.
/// They hold positions alone, in the order of the mesh's vertices, and go with the mesh at rest, in
/// a file of its own. The file appears under its name on commit(), and only then.
class PointCacheWriter {
public:
  /// \param path    .pc2 or .mdd
  /// \param points  V, how many positions each frame has
  /// \param frames  F, how many frames will follow
  /// Errors: unsupported (another extension; more vertices or frames than the file can count),
  /// mismatch (no frame), invalid_option (times that are not finite, or no frames a second),
  /// cannot_write.
  static Result<PointCacheWriter> create(const std::filesystem::path& path, std::size_t points,
                                         std::size_t frames, const FrameTimes& times = {});

  PointCacheWriter(PointCacheWriter&& other) noexcept;
  PointCacheWriter& operator=(PointCacheWriter&&) = delete;
  ~PointCacheWriter();

  /// Adds the next frame: V positions, rounded to floats.
  /// Errors: mismatch (another number of positions, or more frames than were told), cannot_write
  /// (also for a position that is not finite, or too large for a float).
  Status append(std::span<const Vec3> positions);

  /// Gives the file its name. Errors: mismatch (fewer frames than were told), cannot_write.
  Status commit();

private:
  struct File;
  explicit PointCacheWriter(std::unique_ptr<File> file);
  std::unique_ptr<File> file_;
};

} // namespace cagewright
