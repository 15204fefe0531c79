/// \file
/// Walks through a text file, line by line and word by word.
#pragma once

#include "io/source.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

namespace cagewright {

/// A position in a text. Lines end with \n, \r\n or \r alone, in any mixture: files are put
/// together from others. Words are separated by blanks; '#' at the start of a word, or right after
/// a number, begins a comment that ends with the line (elsewhere it does not: some programs write
/// nan as 1.#QNAN). No memory is allocated and every byte is looked at about once.
class TextCursor {
public:
  /// What a backslash before a line end means: OBJ carries lists of numbers on.
  enum class Backslash { is_text, continues };

  explicit TextCursor(const Source& source, Backslash backslash = Backslash::is_text)
      : source_(source), at_(source.bytes.data()), end_(at_ + length_of_text(source.bytes)) {
    set_backslash(backslash);
    if (source.bytes.starts_with("\xef\xbb\xbf")) {
      at_ += 3; // the mark that some editors put before UTF-8 text
    }
  }

  /// From here on. In a name a backslash is text even at the line's end: the second byte of many
  /// characters of Shift-JIS and GBK is one.
  void set_backslash(Backslash backslash) { continues_ = backslash == Backslash::continues; }

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] std::size_t offset() const {
    return static_cast<std::size_t>(at_ - source_.bytes.data());
  }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  void move_to(std::size_t offset) { at_ = std::min(source_.bytes.data() + offset, end_); }

  void skip_blanks() {
    while (at_ != end_ && (is_blank(*at_) || (*at_ == '\\' && skip_continuation()))) {
      ++at_;
    }
  }

  /// Whether no word is left on this line. Call after skip_blanks().
  [[nodiscard]] bool at_line_end() const { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }

  /// To the start of the next line, past comments and continued lines.
  void next_line() {
    while (true) {
      const char* const begin = at_;
      while (at_ != end_ && !is_line_end(*at_)) {
        ++at_;
      }
      const char* const line_end = at_;
      if (at_ == end_) {
        return;
      }
      pass_line_end();
      if (!continues_ || !ends_in_backslash(begin, line_end)) {
        return;
      }
    }
  }

  /// To the next word of the file, past blanks, line ends and comments; false at its end.
  bool next_word_of_file() {
    for (skip_blanks(); at_line_end(); skip_blanks()) {
      if (at_ == end_) {
        return false;
      }
      next_line();
    }
    return true;
  }

  /// The word here, without moving.
  [[nodiscard]] std::string_view peek_word() const {
    const char* to = at_;
    while (to != end_ && !is_blank(*to) && !is_line_end(*to) &&
           !(*to == '\\' && continues_at(to))) {
      ++to;
    }
    return {at_, static_cast<std::size_t>(to - at_)};
  }

  std::string_view word() {
    const std::string_view text = peek_word();
    at_ += text.size();
    return text;
  }

  /// What is left of the line, without blanks around it. Comments and backslashes count as text:
  /// this is for names.
  std::string_view rest_of_line() {
    const char* to = at_;
    while (to != end_ && !is_line_end(*to)) {
      ++to;
    }
    const char* from = at_;
    at_ = to;
    while (from != to && is_blank(*from)) {
      ++from;
    }
    while (from != to && is_blank(to[-1])) {
      --to;
    }
    return {from, static_cast<std::size_t>(to - from)};
  }

  /// The number here, rounded correctly; none, without moving, where there is none. It may be
  /// infinite or not a number, which files hold in places that do not matter.
  /// fast_float, because strtod depends on the locale, streams are slow, and not all standard
  /// libraries have std::from_chars for it.
  std::optional<double> any_number() {
    const char* from = at_;
    if (from != end_ && *from == '+' && from + 1 != end_ && from[1] != '-') {
      ++from; // from_chars takes no plus
    }
    double value = 0; // 0 or infinity where a number is beyond the range of double
    const auto [to, error] = fast_float::from_chars(from, end_, value);
    if (error == std::errc::invalid_argument) {
      return std::nullopt;
    }
    if (!ends_number(to)) {
      return unusual_number();
    }
    at_ = to;
    return value;
  }

  /// The same, but none where the number is not finite.
  std::optional<double> number() {
    const char* const before = at_;
    const std::optional<double> value = any_number();
    if (value && !std::isfinite(*value)) {
      at_ = before;
      return std::nullopt;
    }
    return value;
  }

  /// The integer here; none, without moving, where there is none or it needs more than 64 bits.
  std::optional<std::int64_t> integer() {
    const std::optional<std::int64_t> value = integer_prefix();
    if (value && !ends_number(at_)) {
      at_ = before_prefix_;
      return std::nullopt;
    }
    return value;
  }

  /// The same for an integer that text may follow at once, as in "12/3".
  std::optional<std::int64_t> integer_prefix() {
    before_prefix_ = at_;
    const char* from = at_;
    if (from != end_ && *from == '+' && from + 1 != end_ && from[1] != '-') {
      ++from;
    }
    std::int64_t value = 0;
    const auto [to, error] = std::from_chars(from, end_, value);
    if (error != std::errc()) {
      return std::nullopt;
    }
    at_ = to;
    return value;
  }

  /// Passes the character if it stands here.
  bool skip(char c) {
    if (at_ != end_ && *at_ == c) {
      ++at_;
      return true;
    }
    return false;
  }

  /// Whether a number that ends here is all of its word.
  [[nodiscard]] bool at_number_end() const { return ends_number(at_); }

  /// "name:line" of this position.
  [[nodiscard]] std::string place() const { return source_.place_in_line(offset()); }

  /// The error "name:line: what" for the line of this position.
  [[nodiscard]] Error error(std::string_view what) const {
    return source_.error_in_line(offset(), what);
  }

private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

  /// Without the zeros and the Control-Z that some programs leave behind a text.
  static std::size_t length_of_text(std::string_view bytes) {
    const std::size_t last = bytes.find_last_not_of(std::string_view("\0\x1a", 2));
    return last == bytes.npos ? bytes.size() : last + 1;
  }

  /// Past the line end here, which may be two bytes.
  void pass_line_end() { at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1; }

  /// Numbers as Fortran (1.5D+00) and older C libraries of Windows (1.#QNAN, -1.#IND00, 1.#INF)
  /// write them, which from_chars() does not know.
  std::optional<double> unusual_number() {
    std::string_view text = peek_word();
    constexpr std::size_t longest = 64; // more digits than Fortran writes
    const std::size_t mark = text.find_first_of("dD#");
    if (mark == text.npos || mark == 0 || text.size() > longest) {
      return std::nullopt;
    }
    if (text[mark] == '#') {
      const std::string_view what = text.substr(mark + 1);
      const bool is_infinite = what.starts_with("INF");
      const bool is_mark = !what.empty() && std::all_of(what.begin(), what.end(), [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
      });
      if (text[mark - 1] != '.' || !is_mark) {
        return std::nullopt;
      }
      at_ += text.size();
      constexpr double infinity = std::numeric_limits<double>::infinity();
      return is_infinite ? (text[0] == '-' ? -infinity : infinity)
                         : std::numeric_limits<double>::quiet_NaN();
    }
    std::array<char, longest> copy{};
    text = text.substr(0, std::min(text.find('#'), text.size())); // a comment may follow at once
    std::copy(text.begin(), text.end(), copy.begin());
    copy[mark] = 'e';
    TextCursor word(Source{source_.name, std::string_view(copy.data(), text.size())});
    const std::optional<double> value = word.any_number();
    if (value && word.at_end()) {
      at_ += text.size();
      return value;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool ends_word(const char* p) const {
    return p == end_ || is_blank(*p) || is_line_end(*p) || (*p == '\\' && continues_at(p));
  }

  /// The same right after a number, which a comment may follow at once.
  [[nodiscard]] bool ends_number(const char* p) const {
    return ends_word(p) || (*p == '#' && p[-1] != '.');
  }

  /// Whether the backslash at p is the last of its line and carries it on.
  [[nodiscard]] bool continues_at(const char* p) const {
    if (!continues_) {
      return false;
    }
    for (++p; p != end_ && is_blank(*p); ++p) {
    }
    return p == end_ || is_line_end(*p);
  }

  /// From a backslash that carries the line on to the line's end.
  bool skip_continuation() {
    if (!continues_at(at_)) {
      return false;
    }
    while (at_ + 1 != end_ && !is_line_end(*at_)) {
      ++at_;
    }
    if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') {
      ++at_;
    }
    return true;
  }

  /// Whether the line from `begin` to its end goes on with the next one. A comment does not: it may
  /// well end in the name of a Windows folder.
  [[nodiscard]] static bool ends_in_backslash(const char* begin, const char* line_end) {
    const char* p = line_end;
    while (p != begin && is_blank(p[-1])) {
      --p;
    }
    return p != begin && p[-1] == '\\' &&
           std::memchr(begin, '#', static_cast<std::size_t>(p - begin)) == nullptr;
  }

  Source source_;
  const char* at_;
  const char* end_;
  const char* before_prefix_ = nullptr;
  bool continues_ = false;
};

} // namespace cagewright
