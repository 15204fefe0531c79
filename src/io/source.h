/// \file
/// What the readers of all formats share: the bytes of a file and how to complain about them.
#pragma once

#include <cagewright/core/result.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace cagewright {

/// The text as part of a message: control characters and bytes beyond ASCII's end become '?' unless
/// they belong to UTF-8, and what is longer than `limit` bytes is cut short.
std::string one_line(std::string_view text, std::size_t limit = 4096);

/// A piece of the file in quotes, short enough for a message.
std::string in_quotes(std::string_view text);

/// "1 face", "3 faces".
std::string counted(std::size_t count, std::string_view noun);

/// The bytes of a file and its name. Nothing is owned.
struct Source {
  std::string_view name;
  std::string_view bytes;

  /// "name: what"
  [[nodiscard]] Error error(std::string_view what, ErrorCode code = ErrorCode::malformed) const;

  /// "name:line: what", for the line that holds `offset` in a text file. Counts the lines, so that
  /// readers need not.
  [[nodiscard]] Error error_in_line(std::size_t offset, std::string_view what,
                                    ErrorCode code = ErrorCode::malformed) const;

  /// "name:line", for the line that holds `offset` in a text file.
  [[nodiscard]] std::string place_in_line(std::size_t offset) const;

  /// "name: byte offset" and "name: byte offset: what", for a binary file.
  [[nodiscard]] std::string place_at_byte(std::size_t offset) const;
  [[nodiscard]] Error error_at_byte(std::size_t offset, std::string_view what,
                                    ErrorCode code = ErrorCode::malformed) const;
};

/// The file shows no surface: "name: has no faces; ...".
Error no_faces(const Source& source);

/// More vertices than an index can count: "name: has ... vertices; ...".
Error too_many_vertices(const Source& source, std::size_t count);

/// A corner names a vertex that is not there: "<face> refers to vertex <vertex>, but there are
/// <count>; export the model again". The vertex is a text, because it may be beyond any integer.
std::string no_such_vertex(std::string_view face, std::string_view vertex, std::size_t count);

/// Whether the digits are grouped by signs between them: "1,000", "1.234.567", "1'000".
bool has_thousands_separators(std::string_view digits);

/// What a word is that should be a finite number, and what helps: "'0,5' has a decimal comma; ...".
std::string not_a_number(std::string_view word);

/// What helps against most damaged files; the end of many messages.
inline constexpr std::string_view export_again = "; export the model again";

} // namespace cagewright
