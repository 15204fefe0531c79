/// \file
/// What every fuzzer asks: a promise that does not hold ends the program, so that the fuzzer keeps
/// the bytes.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace cagewright::fuzz {

inline void require(bool holds, std::string_view what) {
  if (!holds) {
    std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
    std::abort();
  }
}

/// A message is one line of printable text, so that a terminal shows it and nothing else.
inline void require_one_line(std::string_view message) {
  bool is_line = !message.empty();
  for (const char c : message) {
    is_line = is_line && static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  }
  if (!is_line) {
    std::fprintf(stderr, "message: %.*s\n", static_cast<int>(message.size()), message.data());
  }
  require(is_line, "a message is one line");
}

} // namespace cagewright::fuzz
