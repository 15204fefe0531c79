#include "session.h"

#include "io/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <mutex>

namespace cagewright::cli {
namespace {

const Session* session_at_hand = nullptr;

/// What the user should read: being stopped by a limit is more than being stopped.
Error as_told(const Error& error) {
  if (error.code != ErrorCode::cancelled || session_at_hand == nullptr ||
      !session_at_hand->out_of_time) {
    return error;
  }
  return {
      ErrorCode::cancelled,
      fmt::format("the time limit of {} is reached, {}; allow more with --time-limit, or ask for "
                  "less (fewer vertices, a lower resolution)",
                  seconds_as_text(session_at_hand->limits.seconds),
                  has_written_files() ? "perhaps before all was written (each file that is "
                                        "there is whole)"
                                      : "nothing was written")};
}

} // namespace

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

void Session::say(std::string_view text) const {
  if (!quiet) {
    std::fwrite(text.data(), 1, text.size(), json == "-" ? stderr : stdout);
  }
}

void Session::begin() {
  session_at_hand = this;
}

ExitCode exit_code_of(const Error& error) {
  switch (error.code) {
  case ErrorCode::cancelled:
    return session_at_hand != nullptr && session_at_hand->out_of_time ? limit_reached : interrupted;
  case ErrorCode::too_large:
    return limit_reached;
  case ErrorCode::no_valid_cage:
  case ErrorCode::not_available:
    return not_satisfiable;
  default:
    return bad_input;
  }
}

int fail(const Error& error) {
  static std::mutex mutex; // whoever ends the program is another thread
  const std::lock_guard lock(mutex);
  const Error told = as_told(error);
  if (session_at_hand != nullptr && session_at_hand->first_failure &&
      session_at_hand->first_failure->code == ErrorCode::cancelled) {
    return exit_code_of(error); // that is told once
  }
  std::fprintf(stderr, "%scagewright: %s\n", isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "",
               told.message.c_str());
  if (session_at_hand != nullptr && !session_at_hand->first_failure) {
    session_at_hand->first_failure = told;
  }
  return exit_code_of(error);
}

void warn(std::string_view message) {
  std::fprintf(stderr, "cagewright: warning: %.*s\n", static_cast<int>(message.size()),
               message.data());
}

} // namespace cagewright::cli
