#include "io/source.h"

#include <algorithm>

namespace cagewright {

std::string one_line(std::string_view text, std::size_t limit) {
  std::string line(text.substr(0, limit));
  std::replace_if(
      line.begin(), line.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text.size() > limit ? line + "..." : line;
}

std::string in_quotes(std::string_view text) {
  std::string shown = one_line(text, 40);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; },
      '?'); // cutting may have halved a character
  return '\'' + shown + '\'';
}

std::string counted(std::size_t count, std::string_view noun) {
  const bool ends_in_x = !noun.empty() && noun.back() == 'x'; // vertex, vertices
  std::string text = std::to_string(count) + ' ';
  if (count == 1) {
    return text.append(noun);
  }
  return ends_in_x ? text.append(noun.substr(0, noun.size() - 2)).append("ices")
                   : text.append(noun).append("s");
}

Error Source::error(std::string_view what, ErrorCode code) const {
  return {code, one_line(name) + ": " + std::string(what)};
}

std::string Source::place_in_line(std::size_t offset) const {
  // Line ends are \n or \r\n, or on old Macintoshes \r alone; some files mix them.
  std::size_t line = 1;
  const std::string_view before = bytes.substr(0, offset);
  for (std::size_t i = 0; i < before.size(); ++i) {
    line += before[i] == '\n' || (before[i] == '\r' && bytes.substr(i + 1, 1) != "\n") ? 1 : 0;
  }
  return one_line(name) + ':' + std::to_string(line);
}

Error Source::error_in_line(std::size_t offset, std::string_view what, ErrorCode code) const {
  return {code, place_in_line(offset) + ": " + std::string(what)};
}

Error Source::error_at_byte(std::size_t offset, std::string_view what, ErrorCode code) const {
  return {code, one_line(name) + ": byte " + std::to_string(offset) + ": " + std::string(what)};
}

Error no_faces(const Source& source) {
  return source.error("has no faces; a surface is needed: export the model as a mesh, not as "
                      "points or curves");
}

Error too_many_vertices(const Source& source, std::size_t count) {
  return source.error("has " + std::to_string(count) +
                          " vertices, more than the 4294967295 that can be counted; simplify the "
                          "model",
                      ErrorCode::unsupported);
}

std::string no_such_vertex(std::string_view face, std::string_view vertex, std::size_t count) {
  return std::string(face) + " refers to vertex " + std::string(vertex) + ", but there " +
         (count == 1 ? "is " : "are ") + std::to_string(count) + std::string(export_again);
}

} // namespace cagewright
