/// \file
/// The container of binary glTF files (glTF 2.0, 4).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cagewright {

/// A length of 32 bits, lowest byte first.
inline void append_glb_size(std::string& bytes, std::size_t size) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes.push_back(static_cast<char>((size >> (8 * i)) & 0xffU));
  }
}

/// A multiple of four, as all chunks are long.
constexpr std::size_t padded_glb_size(std::size_t size) {
  return (size + 3) / 4 * 4;
}

inline void append_glb_chunk(std::string& bytes, std::string_view type, std::string_view content,
                             char padding) {
  const std::size_t size = padded_glb_size(content.size());
  append_glb_size(bytes, size);
  bytes.append(type).append(content).append(size - content.size(), padding);
}

} // namespace cagewright
