/// \file
/// Text in UTF-16, as Windows programs and PowerShell's redirection write it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cagewright {

/// The text as UTF-8 if the bytes begin with the mark of UTF-16 (either byte order); none for other
/// bytes. Halves of pairs without the other half become U+FFFD. Cost: O(bytes).
inline std::optional<std::string> text_from_utf16(std::string_view bytes) {
  const bool little = bytes.starts_with("\xff\xfe");
  if (!little && !bytes.starts_with("\xfe\xff")) {
    return std::nullopt;
  }
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(little ? second << 8U | first : first << 8U | second);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
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
