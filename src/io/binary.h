/// \file
/// Numbers in binary files.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace cagewright {

/// The number stored at `from`, which need not be aligned; sizeof(T) bytes are read.
template <class T> T load(const char* from, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> bytes;
  if (order == std::endian::native) {
    std::memcpy(bytes.data(), from, sizeof(T));
  } else {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes[i] = from[sizeof(T) - 1 - i];
    }
  }
  return std::bit_cast<T>(bytes);
}

} // namespace cagewright
