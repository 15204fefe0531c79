/// \file
/// How long the program may take and how much memory, so that a slip of the finger does not bring
/// a workstation to a halt.
#pragma once

#include <CLI/CLI.hpp>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace cagewright::cli {

struct Limits {
  double seconds = 3600;        ///< 0: none
  std::uint64_t bytes = 0;      ///< 0: none; add_limit_options() puts the default here
  bool is_memory_given = false; ///< on the command line
  bool is_for_each = false;     ///< of the models of a batch: they do not hold for this process
};

/// Declares --time-limit and --memory-limit, for all commands.
void add_limit_options(CLI::App& app, Limits& limits);

/// "2.5 GB"
std::string bytes_as_text(std::uint64_t bytes);
/// "90 s", "10 min", "1 h"
std::string seconds_as_text(double seconds);

/// From now on the program gets no more memory than that: allocations beyond fail. 0: no limit.
void limit_memory(std::uint64_t bytes);

/// Calls `expired` once the time is over, and `overdue` when this object still lives some seconds
/// later, and again. Without a limit it does nothing.
class Deadline {
public:
  Deadline(double seconds, std::function<void()> expired, std::function<void()> overdue);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

private:
  bool wait(std::chrono::duration<double> time);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread thread_;
};

} // namespace cagewright::cli
