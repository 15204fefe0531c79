/// \file
/// The first word of an OFF file.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace cagewright {

/// What the letters before "OFF" say about a vertex: x y z [w] [normal] [colour] [texture].
struct OffHeader {
  bool has_texture = false; ///< ST
  bool has_color = false;   ///< C
  bool has_normal = false;  ///< N
  bool has_weight = false;  ///< 4: homogeneous coordinates
  bool has_size = false;    ///< n: points of another dimension
};

/// The header that a word is, its letters in any order, as programs differ; none for other words.
constexpr std::optional<OffHeader> off_header(std::string_view word) {
  if (!word.ends_with("OFF")) {
    return std::nullopt;
  }
  word.remove_suffix(3);
  OffHeader header;
  while (!word.empty()) {
    if (word.starts_with("ST")) {
      header.has_texture = true;
      word.remove_prefix(1);
    } else if (word[0] == 'C') {
      header.has_color = true;
    } else if (word[0] == 'N') {
      header.has_normal = true;
    } else if (word[0] == '4') {
      header.has_weight = true;
    } else if (word[0] == 'n') {
      header.has_size = true;
    } else {
      return std::nullopt;
    }
    word.remove_prefix(1);
  }
  return header;
}

/// Bytes of a vertex in a binary file: floats only.
constexpr std::size_t off_vertex_size(const OffHeader& header) {
  return 12 + (header.has_normal ? 12 : 0) + (header.has_color ? 16 : 0) +
         (header.has_texture ? 8 : 0);
}

} // namespace cagewright
