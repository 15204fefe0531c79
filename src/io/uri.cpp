#include "io/uri.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace cagewright {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') {
    return c - '0';
  }
  const char lower = static_cast<char>(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  return result;
}

} // namespace

std::optional<std::string> decode_base64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  constexpr std::string_view blank = " \t\r\n"; // lines of mail and of pretty printers
  while (!text.empty() && (text.back() == '=' || blank.find(text.back()) != blank.npos)) {
    text.remove_suffix(1);
  }
  for (const char c : text) {
    if (blank.find(c) != blank.npos) {
      continue;
    }
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z') {
      value = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      value = static_cast<std::uint32_t>(c - 'a') + 26;
    } else if (c >= '0' && c <= '9') {
      value = static_cast<std::uint32_t>(c - '0') + 52;
    } else if (c == '+' || c == '-') {
      value = 62;
    } else if (c == '/' || c == '_') {
      value = 63;
    } else {
      return std::nullopt;
    }
    bits = (bits << 6U) | value;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>((bits >> static_cast<unsigned>(count)) & 0xffU));
    }
  }
  return bytes;
}

std::string decode_percent(std::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
        hex_digit(uri[i + 2]) >= 0) {
      name.push_back(static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])));
      i += 2;
    } else {
      name.push_back(uri[i]);
    }
  }
  return name;
}

bool is_data_uri(std::string_view uri) {
  return lower(uri.substr(0, 5)) == "data:";
}

std::optional<std::string> decode_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos) {
    return std::nullopt;
  }
  const std::string_view head = uri.substr(0, comma);
  std::string data(uri.substr(comma + 1));
  if (data.find('%') != data.npos) {
    data = decode_percent(data);
  }
  constexpr std::string_view mark = ";base64";
  const bool is_base64 =
      head.size() >= mark.size() && lower(head.substr(head.size() - mark.size())) == mark;
  return is_base64 ? decode_base64(data) : std::optional(std::move(data));
}

std::string data_uri(std::string_view bytes) {
  return "data:application/octet-stream;base64," + encode_base64(bytes);
}

std::string encode_base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      bits = (bits << 8U) | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text.push_back(k <= count ? digits[(bits >> (18U - 6U * k)) & 63U] : '=');
    }
  }
  return text;
}

std::string encode_percent(std::string_view name) {
  constexpr std::string_view hex = "0123456789ABCDEF";
  constexpr std::string_view plain = "-._~";
  std::string uri;
  for (const char c : name) {
    const bool is_word = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (is_word || plain.find(c) != plain.npos) {
      uri.push_back(c);
    } else {
      const auto byte = static_cast<unsigned char>(c);
      uri.push_back('%');
      uri.push_back(hex[byte >> 4U]);
      uri.push_back(hex[byte & 15U]);
    }
  }
  return uri;
}

} // namespace cagewright
