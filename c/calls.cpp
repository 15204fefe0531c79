#include "calls.h"

#include "core/arena.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace cagewright::c {
namespace {

/// Asks a callback again and again whether to stop, on a thread of its own, for as long as it
/// lives.
class Watcher {
public:
  Watcher(int (*cancelled)(void*), void* user, StopFlag stop)
      : thread_([this, cancelled, user, stop = std::move(stop)] {
          constexpr std::chrono::milliseconds interval(50);
          std::unique_lock lock(mutex_);
          while (!changed_.wait_for(lock, interval, [this] { return over_; })) {
            lock.unlock();
            if (cancelled(user) != 0) {
              stop.request_stop();
              return;
            }
            lock.lock();
          }
        }) {}
  ~Watcher() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread thread_; // last: it uses the others
};

cw_code report(cw_error** error, cw_code code, std::string_view message) noexcept {
  if (error != nullptr) {
    try {
      *error = new cw_error{code, std::string(message)};
    } catch (...) {
      *error = nullptr; // no memory for the sentence: the code must do
    }
  }
  return code;
}

constexpr std::string_view no_memory = "not enough memory";

Progress progress_of(const cw_control& control, const StopFlag& stop) {
  if (control.report == nullptr) {
    return Progress(stop);
  }
  return Progress(stop, [control, stop](double fraction, std::string_view step) {
    if (control.report(control.user, fraction, std::string(step).c_str()) != 0) {
      stop.request_stop();
    }
  });
}

} // namespace

cw_code code_of(ErrorCode code) {
  switch (code) {
  case ErrorCode::cannot_open:
    return CW_CANNOT_OPEN;
  case ErrorCode::cannot_write:
    return CW_CANNOT_WRITE;
  case ErrorCode::malformed:
    return CW_MALFORMED;
  case ErrorCode::unsupported:
    return CW_UNSUPPORTED;
  case ErrorCode::too_large:
    return CW_TOO_LARGE;
  case ErrorCode::unfit_model:
    return CW_UNFIT_MODEL;
  case ErrorCode::invalid_cage:
    return CW_INVALID_CAGE;
  case ErrorCode::invalid_option:
    return CW_INVALID_OPTION;
  case ErrorCode::no_valid_cage:
    return CW_NO_VALID_CAGE;
  case ErrorCode::mismatch:
    return CW_MISMATCH;
  case ErrorCode::not_available:
    return CW_NOT_AVAILABLE;
  case ErrorCode::cancelled:
    return CW_CANCELLED;
  }
  return CW_INTERNAL; // no default above: the compiler points here when a code is added
}

cw_code call(cw_error** error, const std::function<Status()>& body) noexcept {
  if (error != nullptr) {
    *error = nullptr;
  }
  try {
    const Status status = body();
    return status ? CW_OK : report(error, code_of(status.error().code), status.error().message);
  } catch (const std::bad_alloc&) {
    return report(error, CW_TOO_LARGE, no_memory);
  } catch (const std::length_error&) {
    return report(error, CW_TOO_LARGE, no_memory);
  } catch (const std::system_error&) { // a thread without room for its stack
    return report(error, CW_TOO_LARGE, no_memory);
  } catch (const std::exception& e) {
    return report(error, CW_INTERNAL, e.what());
  } catch (...) {
    return report(error, CW_INTERNAL, "internal error");
  }
}

Status all_given(std::initializer_list<Needed> needed) {
  for (const Needed& one : needed) {
    if (one.argument == nullptr) {
      return Error{ErrorCode::malformed, std::string(one.name) + " is missing (NULL)"};
    }
  }
  return success();
}

cw_code call(cw_error** error, const cw_control* given,
             const std::function<Status(const Progress&)>& body) noexcept {
  return call(error, [&]() -> Status {
    const cw_control control = known_part(given);
    const StopFlag stop = control.stop != nullptr ? control.stop->flag : StopFlag();
    const Progress progress = progress_of(control, stop);
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    std::optional<Watcher> watcher;
    if (control.cancelled != nullptr) {
      watcher.emplace(control.cancelled, control.user, stop);
    }
    tbb::task_arena arena(arena_slots(control.threads));
    return arena.execute([&] { return body(progress); });
  });
}

template <class T> T known_part(const T* given) {
  T known = {};
  if (given != nullptr) {
    std::memcpy(&known, given, std::min(given->size, sizeof known));
  }
  return known;
}

template cw_control known_part(const cw_control*);
template cw_deformer_options known_part(const cw_deformer_options*);
template cw_sequence_options known_part(const cw_sequence_options*);
template cw_render_options known_part(const cw_render_options*);

} // namespace cagewright::c
