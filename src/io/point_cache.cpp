#include <cagewright/io/point_cache.h>

#include "io/atomic_file.h"
#include "io/float_range.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace cagewright {
namespace {

constexpr std::string_view pc2 = ".pc2";
constexpr std::string_view mdd = ".mdd";

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

template <class T> void put(std::string& bytes, T value, std::endian order) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (order != std::endian::native) {
    std::reverse(raw.begin(), raw.end());
  }
  bytes.append(raw.data(), raw.size());
}

/// The head of the file; frames follow.
std::string head_of(std::int32_t points, std::int32_t frames, const FrameTimes& times,
                    std::endian order) {
  std::string bytes;
  if (order == std::endian::little) {
    bytes.append("POINTCACHE2\0", 12);
    put<std::int32_t>(bytes, 1, order); // version
    put(bytes, points, order);
    put(bytes, static_cast<float>(times.first_frame), order);
    put(bytes, 1.0F, order); // frames from one sample to the next
    put(bytes, frames, order);
    return bytes;
  }
  put(bytes, frames, order);
  put(bytes, points, order);
  for (std::int32_t f = 0; f < frames; ++f) {
    put(bytes, static_cast<float>((times.first_frame + f) / times.frames_per_second), order);
  }
  return bytes;
}

} // namespace

struct PointCacheWriter::File {
  std::string name; // for messages
  PartFile part;
  std::endian order;
  std::size_t points;
  std::size_t frames;
  std::size_t written = 0;
  std::string bytes; // of a frame
};

bool is_point_cache(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == pc2 || extension == mdd;
}

PointCacheWriter::PointCacheWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
PointCacheWriter::PointCacheWriter(PointCacheWriter&&) noexcept = default;
PointCacheWriter::~PointCacheWriter() = default;

Result<PointCacheWriter> PointCacheWriter::create(const std::filesystem::path& path,
                                                  std::size_t points, std::size_t frames,
                                                  const FrameTimes& times) {
  const std::string name = path.string();
  if (!is_point_cache(path)) {
    return Error{ErrorCode::unsupported, name + ": point caches are written as .pc2 or .mdd"};
  }
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (points > most || frames > most) {
    return Error{ErrorCode::unsupported,
                 name + ": more vertices or frames than the file can count"};
  }
  if (frames == 0) {
    return Error{ErrorCode::mismatch, name + ": there is no frame"};
  }
  if (!std::isfinite(times.first_frame) || !std::isfinite(times.frames_per_second) ||
      times.frames_per_second <= 0) {
    return Error{ErrorCode::invalid_option,
                 name + ": a sequence has a first frame and more than 0 frames a second"};
  }
  Result<PartFile> part = PartFile::create(path);
  if (!part) {
    return part.error();
  }
  const std::endian order = extension_of(path) == pc2 ? std::endian::little : std::endian::big;
  if (Status s = part->append(head_of(static_cast<std::int32_t>(points),
                                      static_cast<std::int32_t>(frames), times, order));
      !s) {
    return s.error();
  }
  return PointCacheWriter(
      std::make_unique<File>(File{name, *std::move(part), order, points, frames, 0, {}}));
}

Status PointCacheWriter::append(std::span<const Vec3> positions) {
  File& file = *file_;
  if (positions.size() != file.points) {
    return Error{ErrorCode::mismatch,
                 file.name + ": a frame has " + std::to_string(positions.size()) +
                     " positions, the mesh has " + std::to_string(file.points)};
  }
  if (file.written == file.frames) {
    return Error{ErrorCode::mismatch,
                 file.name + ": more frames than the " + std::to_string(file.frames) + " told"};
  }
  file.bytes.clear();
  for (const Vec3& p : positions) {
    if (!fits_floats(p)) {
      return Error{ErrorCode::cannot_write,
                   file.name + ": a position of frame " + std::to_string(file.written) +
                       ", counted from 0, is not finite, or too large for the file's numbers"};
    }
    for (const double coordinate : p) {
      put(file.bytes, static_cast<float>(coordinate), file.order);
    }
  }
  ++file.written;
  return file.part.append(file.bytes);
}

Status PointCacheWriter::commit() {
  if (file_->written != file_->frames) {
    return Error{ErrorCode::mismatch, file_->name + ": " + std::to_string(file_->written) +
                                          " frames of " + std::to_string(file_->frames)};
  }
  return file_->part.commit();
}

} // namespace cagewright
