/// \file
/// A whole file in memory.
#pragma once

#include <cagewright/core/result.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace cagewright {

/// The bytes of a file, owned.
class FileBytes {
public:
  FileBytes(std::unique_ptr<char[]> data, std::size_t size) : data_(std::move(data)), size_(size) {}
  explicit FileBytes(std::string_view bytes) : data_(new char[bytes.size()]), size_(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), data_.get());
  }

  [[nodiscard]] std::string_view view() const { return {data_.get(), size_}; }

private:
  std::unique_ptr<char[]> data_;
  std::size_t size_;
};

/// Files above this size are refused: 100 million triangles fit.
inline constexpr std::uint64_t largest_file = std::uint64_t{4} << 30U;

/// Reads a regular file, at most `largest_file` bytes. Pipes, devices and directories are refused
/// without being opened, because they may never end.
///
/// Errors: cannot_open, too_large.
Result<FileBytes> read_file(const std::filesystem::path& path);

} // namespace cagewright
