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

std::string Source::place_at_byte(std::size_t offset) const {
  return one_line(name) + ": byte " + std::to_string(offset);
}

Error Source::error_at_byte(std::size_t offset, std::string_view what, ErrorCode code) const {
  return {code, place_at_byte(offset) + ": " + std::string(what)};
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

bool has_thousands_separators(std::string_view digits) {
  if (digits.starts_with('-')) {
    digits.remove_prefix(1);
  }
  const std::size_t first = digits.find_first_not_of("0123456789");
  if (first == 0 || first > 3) {
    return false; // also where there is no other sign
  }
  const char separator = digits[first];
  for (digits.remove_prefix(first); !digits.empty(); digits.remove_prefix(4)) {
    if (digits.size() < 4 || digits[0] != separator ||
        digits.substr(1, 3).find_first_not_of("0123456789") != digits.npos) {
      return false;
    }
  }
  return separator == ',' || separator == '.' || separator == '\'';
}

namespace {

// Signs beside those of numbers that programs write which follow the customs of a language.
struct Sign {
  std::string_view bytes;
  std::string_view what;
};
constexpr Sign signs_of_typesetting[] = {
    {"\xe2\x88\x92", "a minus of typesetting (U+2212); replace it by '-' in the file"},
    {"\xe2\x80\x93", "a dash (U+2013); replace it by '-' in the file"},
    {"\xc2\xa0", "a no-break space (U+00A0); replace it by a blank, or remove it within numbers"},
    {"\xe2\x80\xaf",
     "a no-break space (U+202F); replace it by a blank, or remove it within numbers"},
    {"\xe2\x80\x89", "a thin space (U+2009); replace it by a blank, or remove it within numbers"},
};

} // namespace

std::string not_a_number(std::string_view word) {
  for (const Sign& sign : signs_of_typesetting) {
    if (word.find(sign.bytes) != word.npos) {
      return in_quotes(word) + " has " + std::string(sign.what);
    }
  }
  if (has_thousands_separators(word) && word.find(',') == word.npos) {
    const std::string signs = word.find('.') != word.npos ? "dots" : "apostrophes";
    return in_quotes(word) + " has thousands separators; remove the " + signs +
           " within numbers, or export without grouping of digits (exporting with the same setting "
           "gives the same file)";
  }
  if (word.find(';') != word.npos && word.find_first_not_of("0123456789+-.eE;") == word.npos) {
    return in_quotes(word) +
           " is not a finite number: numbers are separated by blanks; replace ';' "
           "by ' ' in the file";
  }
  const auto commas = std::count(word.begin(), word.end(), ',');
  const bool is_numeric = word.find_first_not_of("0123456789+-.,eEdD") == word.npos &&
                          word.find_first_of("0123456789") != word.npos;
  if (commas == 0 || !is_numeric) {
    return in_quotes(word) + " is not a finite number" + std::string(export_again);
  }
  if (commas == 1 && word.back() != ',' && word.find('.') == word.npos) {
    return in_quotes(word) + " has a decimal comma; replace ',' by '.' in the file, or export with "
                             "'.' as the decimal sign (exporting with the same setting gives the "
                             "same file)";
  }
  if (word.find('.') != word.npos && word.find('.') > word.rfind(',') && word.back() != ',') {
    return in_quotes(word) + " has a thousands separator; remove ',' from the file, or export "
                             "without grouping of digits (exporting with the same setting gives "
                             "the same file)";
  }
  return in_quotes(word) + " is not a finite number: numbers are separated by blanks; replace ',' "
                           "by ' ' in the file";
}

std::string no_such_vertex(std::string_view face, std::string_view vertex, std::size_t count) {
  return std::string(face) + " refers to vertex " + std::string(vertex) + ", but there " +
         (count == 1 ? "is " : "are ") + std::to_string(count) + std::string(export_again);
}

} // namespace cagewright
