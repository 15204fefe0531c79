/// \file
/// A text file again, with other numbers in some places.
#pragma once

#include "io/number_text.h"
#include "io/source.h"
#include "io/text_cursor.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace cagewright {

/// A copy of a file in which some places are replaced, from front to back.
class TextCopy {
public:
  explicit TextCopy(const Source& source) : source_(source) {
    text_.reserve(source.bytes.size() + source.bytes.size() / 4);
  }

  /// The bytes [begin, end) of the file become the digits of a number.
  template <class Number> void replace(std::size_t begin, std::size_t end, Number value) {
    text_.append(source_.bytes.substr(copied_, begin - copied_));
    append_number(text_, value);
    copied_ = end;
  }

  /// The three numbers at the cursor, which the reader has found to be there.
  void replace_numbers(TextCursor& cursor, const Vec3& values) {
    for (const double value : values) {
      cursor.skip_blanks();
      const std::size_t begin = cursor.offset();
      cursor.any_number();
      replace(begin, cursor.offset(), value);
    }
  }

  /// Between the bytes before `at` and those behind.
  void insert(std::size_t at, std::string_view text) {
    text_.append(source_.bytes.substr(copied_, at - copied_));
    text_.append(text);
    copied_ = at;
  }

  std::string take() && {
    text_.append(source_.bytes.substr(copied_));
    return std::move(text_);
  }

private:
  Source source_;
  std::size_t copied_ = 0; // bytes of the file that are done with
  std::string text_;
};

} // namespace cagewright
