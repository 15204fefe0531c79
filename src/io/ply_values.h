/// \file
/// The values of a PLY file after its header, one after the other.
#pragma once

#include "io/binary.h"
#include "io/ply_header.h"
#include "io/text_cursor.h"

#include <bit>
#include <cstdint>
#include <optional>
#include <string>

namespace cagewright {

/// The value stored at `from`; size_of(type) bytes are read.
inline double load_as_double(const char* from, PlyType type, std::endian order) {
  switch (type) {
  case PlyType::int8:
    return load<std::int8_t>(from, order);
  case PlyType::uint8:
    return load<std::uint8_t>(from, order);
  case PlyType::int16:
    return load<std::int16_t>(from, order);
  case PlyType::uint16:
    return load<std::uint16_t>(from, order);
  case PlyType::int32:
    return load<std::int32_t>(from, order);
  case PlyType::uint32:
    return load<std::uint32_t>(from, order);
  case PlyType::int64:
    return static_cast<double>(load<std::int64_t>(from, order));
  case PlyType::uint64:
    return static_cast<double>(load<std::uint64_t>(from, order));
  case PlyType::float32:
    return load<float>(from, order);
  case PlyType::float64:
    return load<double>(from, order);
  }
  return 0;
}

/// Where the values come from: PlyText and PlyBinary have the same members.
///  - begin_row(): to the next row of an element; false at the end of the file
///  - value(type): the next value of the row; none where the row or the file ends
///  - end_row(): past what is left of the row
///  - at_end(): whether nothing stands behind the last value
///  - remaining(), least_size(type): bytes that are left, and that a value takes at least
///  - bad_value(where): the error where value() gave none
///  - error(what), place(): an error about the row, and where it is
///  - begin(), end(): where the last value stands in the file

/// Rows as text. The format's own description has one row to a line; where there are as many lines
/// as rows, a row ends with its line, whatever more that holds. Some programs break rows or put
/// several on a line: else values are counted, not lines.
class PlyText {
public:
  PlyText(const Source& source, const PlyHeader& header) : cursor_(source) {
    cursor_.move_to(header.end);
    by_lines_ = count_lines() == header.rows();
  }

  bool begin_row() { return cursor_.next_word_of_file(); }

  std::optional<double> value(PlyType) {
    cursor_.skip_blanks();
    if (!by_lines_) {
      cursor_.next_word_of_file();
    }
    begin_ = cursor_.offset();
    return cursor_.any_number();
  }

  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return cursor_.offset(); }

  void end_row() {
    if (by_lines_) {
      cursor_.next_line();
    }
  }

  /// Whether nothing stands behind the last value.
  bool at_end() { return !cursor_.next_word_of_file(); }

  [[nodiscard]] std::size_t remaining() const { return cursor_.remaining() + 1; }

  // Every value takes a digit and a blank or line end.
  static std::size_t least_size(PlyType) { return 2; }

  [[nodiscard]] Error bad_value(const std::string& where) const {
    if (!cursor_.at_line_end()) {
      return cursor_.error(not_a_number(cursor_.peek_word()));
    }
    return cursor_.error((by_lines_ ? "the line ends within " : "the file ends within ") + where +
                         (by_lines_ ? "" : "; it is cut short") + std::string(export_again));
  }

  [[nodiscard]] Error error(const std::string& what) const { return cursor_.error(what); }
  [[nodiscard]] std::string place() const { return cursor_.place(); }

private:
  /// Lines with a word on them, from here.
  [[nodiscard]] std::size_t count_lines() const {
    TextCursor ahead = cursor_;
    std::size_t lines = 0;
    for (; ahead.next_word_of_file(); ahead.next_line()) {
      ++lines;
    }
    return lines;
  }

  TextCursor cursor_;
  std::size_t begin_ = 0; // of the last value
  bool by_lines_;
};

class PlyBinary {
public:
  PlyBinary(const Source& source, std::size_t begin, std::endian order)
      : source_(source), at_(begin), order_(order) {}

  bool begin_row() {
    row_ = at_;
    return true;
  }

  std::optional<double> value(PlyType type) {
    const std::size_t size = size_of(type);
    if (remaining() < size) {
      return std::nullopt;
    }
    begin_ = at_;
    at_ += size;
    return load_as_double(source_.bytes.data() + begin_, type, order_);
  }

  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return at_; }

  void end_row() {}
  [[nodiscard]] bool at_end() const { return remaining() == 0; }

  [[nodiscard]] std::size_t remaining() const { return source_.bytes.size() - at_; }

  static std::size_t least_size(PlyType type) { return size_of(type); }

  [[nodiscard]] Error bad_value(const std::string& where) const {
    return source_.error_at_byte(at_, "the file ends within " + where + "; it is cut short" +
                                          std::string(export_again));
  }

  [[nodiscard]] Error error(const std::string& what) const {
    return source_.error_at_byte(row_, what);
  }
  [[nodiscard]] std::string place() const { return source_.place_at_byte(row_); }

private:
  Source source_;
  std::size_t at_;
  std::size_t row_ = 0;   // where the row began
  std::size_t begin_ = 0; // where the last value did
  std::endian order_;
};

} // namespace cagewright
