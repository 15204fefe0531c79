/// \file
/// The statements of OBJ, for all that walk through such a file.
#pragma once

#include "io/text_cursor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace cagewright {

/// "f", or "fo": the name in the first version of the format.
constexpr bool is_obj_face(std::string_view keyword) {
  return keyword == "f" || keyword == "fo";
}

/// Statements beside vertices and faces whose arguments are lists of numbers: lines, points, curves
/// and surfaces.
constexpr bool is_obj_list(std::string_view keyword) {
  constexpr auto lists = std::to_array<std::string_view>(
      {"l", "p", "vp", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con",
       "deg", "bmat", "step", "cstype", "ctech", "stech"});
  return std::find(lists.begin(), lists.end(), keyword) != lists.end();
}

/// Statements that say how things are drawn or where they come from, and change no shape.
constexpr bool is_obj_setting(std::string_view keyword) {
  constexpr auto settings = std::to_array<std::string_view>(
      {"usemap", "maplib", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj",
       "call", "csh", "mg", "res", "bzp", "bsp", "cdc", "cdp", "sharp", "newmtl"});
  return std::find(settings.begin(), settings.end(), keyword) != settings.end();
}

/// The keyword at the cursor. From here to the end of the statement a backslash carries the line on
/// only where a list of numbers goes on. After next_line() it is text again: set_backslash().
inline std::string_view begin_obj_statement(TextCursor& cursor) {
  const std::string_view word = cursor.peek_word();
  const std::string_view name = word.ends_with('\\') ? word.substr(0, word.size() - 1) : word;
  if (name == "v" || name == "vt" || name == "vn" || is_obj_face(name) || is_obj_list(name)) {
    cursor.set_backslash(TextCursor::Backslash::continues);
  }
  return cursor.word();
}

struct ObjCorner {
  std::int64_t vertex;
  std::int64_t texture = 0; ///< 0: none
  std::int64_t normal = 0;  ///< 0: none
};

/// The corner "v", "v/vt", "v//vn" or "v/vt/vn" at the cursor; numbers may be missing behind
/// slashes.
inline std::optional<ObjCorner> read_obj_corner(TextCursor& cursor) {
  const std::optional<std::int64_t> vertex = cursor.integer_prefix();
  if (!vertex) {
    return std::nullopt;
  }
  ObjCorner corner{*vertex};
  if (cursor.skip('/')) {
    corner.texture = cursor.integer_prefix().value_or(0);
    if (cursor.skip('/')) {
      corner.normal = cursor.integer_prefix().value_or(0);
    }
  }
  return corner;
}

} // namespace cagewright
