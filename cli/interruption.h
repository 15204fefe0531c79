/// \file
/// Ctrl-C, and what else asks a program to stop.
#pragma once

#include <cagewright/core/progress.h>

#include <functional>
#include <semaphore.h>
#include <thread>

namespace cagewright::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP ask for a stop by `stop`. What is under way and asks
/// ends by itself. Not everything can ask: a file being read, a picture being drawn, a chain of
/// memory being given back. Where the object still lives a moment after the signal, `overdue` is
/// called on a thread of its own, and again. A second signal ends the program at once. There is one
/// a process.
class Interruption {
public:
  /// \param overdue  none: what is under way has all the time it takes
  Interruption(const StopFlag& stop, std::function<void()> overdue);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

private:
  StopFlag stop_;
  sem_t asked_{}; ///< also for the end
  std::function<void()> overdue_;
  std::thread thread_;
};

} // namespace cagewright::cli
