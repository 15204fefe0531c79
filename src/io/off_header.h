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

/// The header that a word begins with, its letters in any order, as programs differ, and the
/// letters it takes; none for other words. Thousands of published files have the number of vertices
/// right behind it: "OFF642".
struct OffHeaderWord {
  OffHeader header;
  std::size_t length = 0;
};
constexpr std::optional<OffHeaderWord> off_header(std::string_view word) {
  OffHeaderWord found;
  std::string_view left = word;
  while (!left.starts_with("OFF") && !left.starts_with("off")) {
    if (left.starts_with("ST")) {
      found.header.has_texture = true;
      left.remove_prefix(1);
    } else if (left.starts_with('C')) {
      found.header.has_color = true;
    } else if (left.starts_with('N')) {
      found.header.has_normal = true;
    } else if (left.starts_with('4')) {
      found.header.has_weight = true;
    } else if (left.starts_with('n')) {
      found.header.has_size = true;
    } else {
      return std::nullopt;
    }
    left.remove_prefix(1);
  }
  left.remove_prefix(3);
  found.length = word.size() - left.size();
  if (left.find_first_not_of("0123456789") != left.npos) {
    return std::nullopt;
  }
  return found;
}

/// Bytes of a vertex in a binary file: floats only.
constexpr std::size_t off_vertex_size(const OffHeader& header) {
  return 12 + (header.has_normal ? 12 : 0) + (header.has_color ? 16 : 0) +
         (header.has_texture ? 8 : 0);
}

} // namespace cagewright
