/// \file
/// Walks through a text file, line by line and word by word.
#pragma once

#include "io/source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

namespace cagewright {

/// A position in a text. Words are separated by blanks; '#' at the start of a word, or right after
/// a number, begins a comment that ends with the line (elsewhere it does not: some programs write
/// nan as 1.#QNAN). No memory is allocated and every byte is looked at about once.
class TextCursor {
public:
  /// What a backslash before a line end means: OBJ carries the line on.
  enum class Backslash { is_text, continues };

  explicit TextCursor(const Source& source, Backslash backslash = Backslash::is_text)
      : source_(source), at_(source.bytes.data()), end_(at_ + source.bytes.size()),
        line_end_(source.bytes.find('\n') != std::string_view::npos ? '\n' : '\r'),
        continues_(backslash == Backslash::continues) {
    if (source.bytes.starts_with("\xef\xbb\xbf")) {
      at_ += 3; // the mark that some editors put before UTF-8 text
    }
  }

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] std::size_t offset() const {
    return static_cast<std::size_t>(at_ - source_.bytes.data());
  }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  void move_to(std::size_t offset) { at_ = source_.bytes.data() + offset; }

  void skip_blanks() {
    while (at_ != end_ && (is_blank(*at_) || (*at_ == '\\' && skip_continuation()))) {
      ++at_;
    }
  }

  /// Whether no word is left on this line. Call after skip_blanks().
  [[nodiscard]] bool at_line_end() const { return at_ == end_ || *at_ == line_end_ || *at_ == '#'; }

  /// To the start of the next line, past comments and continued lines.
  void next_line() {
    while (true) {
      const auto* found = static_cast<const char*>(std::memchr(at_, line_end_, remaining()));
      const char* const begin = at_;
      at_ = found != nullptr ? found + 1 : end_;
      if (!continues_ || found == nullptr || !ends_in_backslash(begin, found)) {
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
    while (to != end_ && !is_blank(*to) && *to != line_end_ && !(*to == '\\' && continues_at(to))) {
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
    const auto* found = static_cast<const char*>(std::memchr(at_, line_end_, remaining()));
    const char* to = found != nullptr ? found : end_;
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
  /// std::from_chars, because strtod depends on the locale and streams are slow.
  std::optional<double> any_number() {
    const char* from = at_;
    if (from != end_ && *from == '+' && from + 1 != end_ && from[1] != '-') {
      ++from; // from_chars takes no plus
    }
    double value = 0;
    const auto [to, error] = std::from_chars(from, end_, value);
    if (error == std::errc::result_out_of_range) { // which leaves the value as it was
      value = is_tiny({from, to}) ? 0.0 : std::numeric_limits<double>::infinity();
      value = *from == '-' ? -value : value;
    } else if (error != std::errc()) {
      return std::nullopt;
    }
    if (!ends_number(to)) {
      return std::nullopt;
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

  /// The error "name:line: what" for the line of this position.
  [[nodiscard]] Error error(std::string_view what) const {
    return source_.error_in_line(offset(), what);
  }

private:
  [[nodiscard]] bool is_blank(char c) const {
    return c == ' ' || c == '\t' || (c == '\r' && line_end_ != '\r') || c == '\v' || c == '\f';
  }

  [[nodiscard]] bool ends_word(const char* p) const {
    return p == end_ || is_blank(*p) || *p == line_end_ || (*p == '\\' && continues_at(p));
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
    return p == end_ || *p == line_end_;
  }

  /// From a backslash that carries the line on to the line's end.
  bool skip_continuation() {
    if (!continues_at(at_)) {
      return false;
    }
    while (at_ + 1 != end_ && *at_ != line_end_) {
      ++at_;
    }
    return true;
  }

  /// Whether the line from `begin` to its end goes on with the next one. A comment does not: it may
  /// well end in the name of a Windows folder.
  [[nodiscard]] bool ends_in_backslash(const char* begin, const char* line_end) const {
    const char* p = line_end;
    while (p != begin && is_blank(p[-1])) {
      --p;
    }
    return p != begin && p[-1] == '\\' &&
           std::memchr(begin, '#', static_cast<std::size_t>(p - begin)) == nullptr;
  }

  /// Whether a decimal number that has no double is too small for one rather than too large.
  static bool is_tiny(std::string_view digits) {
    const std::size_t e = digits.find_first_of("eE");
    const std::string_view mantissa = digits.substr(0, e);
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
    std::int64_t exponent = 0;
    if (e != digits.npos) {
      const char* from = digits.data() + e + 1;
      from += *from == '+' ? 1 : 0;
      if (std::from_chars(from, digits.data() + digits.size(), exponent).ec != std::errc()) {
        return *from == '-'; // an exponent beyond 64 bits
      }
    }
    return static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first) + exponent < 0;
  }

  Source source_;
  const char* at_;
  const char* end_;
  const char* before_prefix_ = nullptr;
  char line_end_;
  bool continues_;
};

} // namespace cagewright
