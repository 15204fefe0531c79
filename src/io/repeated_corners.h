/// \file
/// Polygons that name a corner twice in a row, as programs write them that have merged vertices.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace cagewright {

/// What is told of it.
inline constexpr std::string_view repeated_corner_note =
    "a face names a corner twice in a row; it is taken once";

/// Removes each corner that names the same vertex as the one before it, the first following the
/// last, where three or more remain; else the face stays as it is. Returns whether any is removed.
template <class Corner, class VertexOf>
bool drop_repeated_corners(std::vector<Corner>& corners, VertexOf vertex_of) {
  const std::size_t n = corners.size();
  const auto repeats = [&](std::size_t i) {
    return vertex_of(corners[i]) == vertex_of(corners[i == 0 ? n - 1 : i - 1]);
  };
  // The first corner stays if the last repeats it.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i) {
    kept += repeats(i) ? 0U : 1U;
  }
  if (kept == n || kept < 3) {
    return false;
  }
  const bool first_repeats = repeats(0);
  std::size_t to = 1;
  for (std::size_t i = 1; i < n; ++i) {
    if (vertex_of(corners[i]) != vertex_of(corners[to - 1])) {
      corners[to++] = corners[i];
    }
  }
  while (first_repeats && to > 3 && vertex_of(corners[to - 1]) == vertex_of(corners[0])) {
    --to;
  }
  corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(to), corners.end());
  return true;
}

} // namespace cagewright
