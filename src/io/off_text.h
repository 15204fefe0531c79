/// \file
/// The start of a text OFF file and the order of the numbers of its vertices, for all that walk
/// through one.
#pragma once

#include "io/off_header.h"
#include "io/text_cursor.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace cagewright {

/// Where on a vertex's line the numbers stand. The format's order is x y z [w] [normal] [colour]
/// [texture]; MeshLab writes colours before normals.
struct OffLayout {
  std::size_t normal = 0; ///< place of the first number, 0: there is none
  std::size_t color = 0;
  std::size_t color_end = 0; ///< as far as the line has numbers, at most
  std::size_t texture = 0;
};

/// The header at the cursor, which moves behind it; none, without moving, where the file begins
/// with its counts.
inline std::optional<OffHeader> take_off_header(TextCursor& cursor) {
  cursor.next_word_of_file();
  const std::optional<OffHeaderWord> word = off_header(cursor.peek_word());
  if (!word) {
    return std::nullopt;
  }
  cursor.move_to(cursor.offset() + word->length);
  return word->header;
}

/// The cursor stands behind the count of faces: moves behind the count of edges, if there is any,
/// on the same line or as the only word of the next (a vertex has three).
inline void skip_off_edges(TextCursor& cursor) {
  cursor.skip_blanks();
  if (!cursor.at_line_end()) {
    return;
  }
  TextCursor ahead = cursor;
  if (!ahead.next_word_of_file()) {
    return;
  }
  const std::size_t begin = ahead.offset();
  if (ahead.integer()) {
    ahead.skip_blanks();
    if (ahead.at_line_end()) {
      cursor.move_to(begin);
    }
  }
}

namespace off_detail {

inline double length(const double* v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

inline bool is_unit(const double* v) {
  constexpr double rounding = 0.02; // files with two digits
  return std::abs(length(v) - 1) < rounding;
}

/// Whether the line with the numbers behind x y z shows a colour before the normal: whole numbers
/// above 1 in the first three, or no unit vector there but one in the last three.
inline bool shows_color_first(const double* more, std::size_t count) {
  bool is_whole = true;
  bool is_above_one = false;
  for (std::size_t i = 0; i < 3; ++i) {
    is_whole &= more[i] == std::floor(more[i]) && more[i] >= 0;
    is_above_one |= more[i] > 1;
  }
  const bool ends_in_unit = is_unit(more + count - 3);
  return ends_in_unit && ((is_whole && is_above_one) || !is_unit(more));
}

} // namespace off_detail

/// The order of a file whose first vertex stands at the cursor.
inline OffLayout off_layout(TextCursor cursor, const OffHeader& header, std::size_t vertices) {
  const std::size_t first = header.has_weight ? 4 : 3;
  OffLayout layout;
  std::size_t at = first;
  if (header.has_normal) {
    layout.normal = at;
    at += 3;
  }
  if (header.has_color) {
    layout.color = at;
    at += 4;
    layout.color_end = at;
  }
  layout.texture = header.has_texture ? at : 0;
  if (!header.has_normal || !header.has_color || header.has_texture) {
    return layout;
  }
  // A few vertices may be black or have a normal of zero; of so many one shows the order.
  constexpr std::size_t looked_at = 256;
  for (std::size_t v = 0; v < vertices && v < looked_at && cursor.next_word_of_file(); ++v) {
    std::array<double, 11> values{};
    std::size_t count = 0;
    for (cursor.skip_blanks(); count < values.size() && !cursor.at_line_end();
         cursor.skip_blanks()) {
      const std::optional<double> value = cursor.any_number();
      if (!value) {
        return layout;
      }
      values[count++] = *value;
    }
    if (count >= first + 6 && off_detail::shows_color_first(&values[first], count - first)) {
      layout.color = first;
      layout.color_end = count - 3;
      layout.normal = count - 3;
      return layout;
    }
    cursor.next_line();
  }
  return layout;
}

} // namespace cagewright
