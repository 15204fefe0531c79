/// \file
/// How long each stage of the pipeline took.
#pragma once

#include <cagewright/cage/generated_cage.h>

#include <chrono>
#include <vector>

namespace cagewright {

/// Notes the time from one lap to the next.
class Stopwatch {
public:
  explicit Stopwatch(std::vector<StageTime>& times) : times_(times) {}

  /// Ends a stage: notes the time since the last one ended, or since the watch was made.
  void lap(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    times_.push_back({stage, std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

private:
  std::vector<StageTime>& times_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace cagewright
