#include "session.h"

#include <unistd.h>

#include <cstdio>
#include <memory>

namespace cagewright::cli {

Progress Session::progress() const {
  if (quiet || isatty(STDERR_FILENO) == 0) {
    return Progress(stop);
  }
  return Progress(stop, [last = std::make_shared<int>(-1)](double fraction, std::string_view step) {
    const int percent = static_cast<int>(fraction * 100);
    if (percent != *last) {
      *last = percent;
      std::fprintf(stderr, "\r\033[K%3d %%  %.*s%s", percent, static_cast<int>(step.size()),
                   step.data(), percent >= 100 ? "\r\033[K" : "");
      std::fflush(stderr);
    }
  });
}

int fail(const Error& error) {
  std::fprintf(stderr, "%scagewright: %s\n", isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "",
               error.message.c_str());
  switch (error.code) {
  case ErrorCode::cancelled:
    return interrupted;
  case ErrorCode::no_valid_cage:
  case ErrorCode::not_available:
    return could_not;
  default:
    return bad_input;
  }
}

} // namespace cagewright::cli
