/// \file
/// What reading a file takes that is not the same on all systems.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace cagewright {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, CloseFile>;

/// Opens a regular file for reading bytes, and says how many it has. Null where that cannot be
/// done, for the reason in errno. It never waits, as for the other end of a pipe.
FilePointer open_regular_file(const std::filesystem::path& path, std::uint64_t& size);

/// Goes to a byte of a file, however large the file is. \returns false where that fails
bool seek_to(std::FILE* file, std::uint64_t offset);

} // namespace cagewright
