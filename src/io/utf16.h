/// \file
/// Text in UTF-16, as Windows programs and PowerShell's redirection write it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cagewright {

/// Whether each second byte is zero, and the others are those of a text in ASCII: of UTF-16 without
/// its mark. \param zero  which byte of two is zero
inline bool is_unmarked_utf16(std::string_view bytes, std::size_t zero) {
  constexpr std::size_t looked_at = 256; // more than the head of any binary file
  const std::size_t count = std::min(bytes.size(), looked_at);
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    const bool is_text = (byte >= 0x20 && byte < 0x7f) || (byte >= '\t' && byte <= '\r');
    if (i % 2 == zero ? byte != 0 : !is_text) {
      return false;
    }
  }
  return count >= 4;
}

/// The text as UTF-8 if the bytes are text in UTF-16 (either byte order), told by its mark or by
/// its zeros; none for other bytes. Halves of pairs without the other half become U+FFFD. Cost:
/// O(bytes).
inline std::optional<std::string> text_from_utf16(std::string_view bytes) {
  using namespace std::string_view_literals;
  const bool marked_little = bytes.starts_with("\xff\xfe") && !bytes.starts_with("\xff\xfe\0\0"sv);
  const bool is_marked = marked_little || bytes.starts_with("\xfe\xff");
  const bool little = marked_little || is_unmarked_utf16(bytes, 1);
  if (!is_marked && !little && !is_unmarked_utf16(bytes, 0)) {
    return std::nullopt;
  }
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(little ? second << 8U | first : first << 8U | second);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = is_marked ? 2 : 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xdc00 && i + 3 < bytes.size() && unit(i + 2) >= 0xdc00 &&
        unit(i + 2) < 0xe000) {
      code = 0x10000 + ((code - 0xd800) << 10U) + (unit(i + 2) - 0xdc00);
      i += 2;
    } else if (code >= 0xd800 && code < 0xe000) {
      code = 0xfffd;
    }
    const auto push = [&](std::uint32_t byte) { text.push_back(static_cast<char>(byte)); };
    if (code < 0x80) {
      push(code);
    } else if (code < 0x800) {
      push(0xc0 | code >> 6U), push(0x80 | (code & 0x3fU));
    } else if (code < 0x10000) {
      push(0xe0 | code >> 12U), push(0x80 | (code >> 6U & 0x3fU)), push(0x80 | (code & 0x3fU));
    } else {
      push(0xf0 | code >> 18U), push(0x80 | (code >> 12U & 0x3fU));
      push(0x80 | (code >> 6U & 0x3fU)), push(0x80 | (code & 0x3fU));
    }
  }
  return text;
}

} // namespace cagewright
