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
///  - remaining(), least_size(type): bytes that are left, and that a value takes at least
///  - bad_value(where): the error where value() gave none
///  - error(what): an error about the row
///  - begin(), end(): where the last value stands in the file

/// One row to a line, as the format's own description has it.
class PlyText {
public:
  PlyText(const Source& source, std::size_t begin) : cursor_(source) { cursor_.move_to(begin); }

  bool begin_row() { return cursor_.next_word_of_file(); }

  std::optional<double> value(PlyType) {
    cursor_.skip_blanks();
    begin_ = cursor_.offset();
    return cursor_.any_number();
  }

  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return cursor_.offset(); }

  void end_row() { cursor_.next_line(); }

  [[nodiscard]] std::size_t remaining() const { return cursor_.remaining() + 1; }

  // Every value takes a digit and a blank or line end.
  static std::size_t least_size(PlyType) { return 2; }

  [[nodiscard]] Error bad_value(const std::string& where) const {
    return cursor_.at_line_end()
               ? cursor_.error("the line ends within " + where + std::string(export_again))
               : cursor_.error(in_quotes(cursor_.peek_word()) + " is not a number" +
                               std::string(export_again));
  }

  [[nodiscard]] Error error(const std::string& what) const { return cursor_.error(what); }

private:
  TextCursor cursor_;
  std::size_t begin_ = 0; // of the last value
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

  [[nodiscard]] std::size_t remaining() const { return source_.bytes.size() - at_; }

  static std::size_t least_size(PlyType type) { return size_of(type); }

  [[nodiscard]] Error bad_value(const std::string& where) const {
    return source_.error_at_byte(at_, "the file ends within " + where + "; it is cut short" +
                                          std::string(export_again));
  }

  [[nodiscard]] Error error(const std::string& what) const {
    return source_.error_at_byte(row_, what);
  }

private:
  Source source_;
  std::size_t at_;
  std::size_t row_ = 0;   // where the row began
  std::size_t begin_ = 0; // where the last value did
  std::endian order_;
};

} // namespace cagewright
