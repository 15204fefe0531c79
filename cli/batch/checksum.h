/// \file
/// Whether a file is the one that was there before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cagewright::cli {

/// FNV-1a over bytes: tells apart files that differ by accident, not by malice.
class Checksum {
public:
  void add(std::string_view bytes);
  /// The bytes of a file, and how many. False: it cannot be read.
  bool add_file(const std::filesystem::path& path);

  [[nodiscard]] std::string text() const; ///< 16 digits and letters

private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// The checksum of a model: of its file, and of the buffers that a glTF file keeps in others.
/// Nothing if it cannot be read.
std::optional<std::string> checksum_of_model(const std::filesystem::path& model);

} // namespace cagewright::cli
