/// \file
/// Numbers from text, whatever the locale.
#pragma once

#include <fast_float/fast_float.h>

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace cagewright {

/// The finite number that text begins with, rounded correctly; then the text goes on behind it.
/// false, and the text as it was, where there is none or it is beyond the range of its type.
/// Not all standard libraries have std::from_chars for what is not an integer.
template <class Number> bool take_number(std::string_view& text, Number& value) {
  const char* const end = text.data() + text.size();
  const char* to = nullptr;
  if constexpr (std::is_floating_point_v<Number>) {
    const auto [after, error] = fast_float::from_chars(text.data(), end, value);
    to = error == std::errc() && std::isfinite(value) ? after : nullptr;
  } else {
    const auto [after, error] = std::from_chars(text.data(), end, value);
    to = error == std::errc() ? after : nullptr;
  }
  if (to == nullptr) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(to - text.data()));
  return true;
}

/// Whether the text is a number, and nothing else.
template <class Number> bool parse_number(std::string_view text, Number& value) {
  return take_number(text, value) && text.empty();
}

} // namespace cagewright
