/// \file
/// How often a computation asks whether to stop, and how long it works without asking.
#pragma once

#include <cagewright/core/progress.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright::test {

/// Work without a question whether to stop.
struct Stretch {
  double seconds = 0; ///< of the process on all its processors: a busy machine does not matter
  std::string step;   ///< that was reported last
};

/// Counts the questions of one computation; answers yes from the k-th on, if that is asked for.
class Polls {
public:
  explicit Polls(std::size_t stop_at = std::numeric_limits<std::size_t>::max())
      : stop_at_(stop_at) {}
  Polls(const Polls&) = delete;
  Polls& operator=(const Polls&) = delete;

  /// For one computation.
  [[nodiscard]] Progress progress() {
    begin_ = last_ = now();
    return Progress(StopFlag([this] { return ask(); }),
                    [this](double fraction, std::string_view step) { report(fraction, step); });
  }

  /// The computation is over.
  void end() {
    const std::lock_guard lock(mutex_);
    note();
    total_ = last_ - begin_;
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double seconds() const { return total_; }
  /// From the first yes to the end.
  [[nodiscard]] double seconds_to_end() const { return stopped_ > 0 ? last_ - stopped_ : 0; }
  /// The longest ones, the longest first.
  [[nodiscard]] const std::vector<Stretch>& longest() const { return longest_; }

  /// What was shown, and when, in seconds of the process.
  struct Shown {
    double seconds = 0;
    double fraction = 0;
    std::string step;
  };
  [[nodiscard]] const std::vector<Shown>& shown() const { return shown_; }

private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  bool ask() {
    const std::lock_guard lock(mutex_);
    note();
    const bool stop = ++count_ >= stop_at_;
    stopped_ = stop && stopped_ == 0 ? last_ : stopped_;
    return stop;
  }

  void report(double fraction, std::string_view step) {
    const std::lock_guard lock(mutex_);
    step_ = step;
    shown_.push_back({now() - begin_, fraction, step_});
  }

  void note() {
    const double time = now();
    constexpr std::size_t kept = 20;
    if (longest_.size() < kept || time - last_ > longest_.back().seconds) {
      longest_.push_back({time - last_, step_});
      std::stable_sort(longest_.begin(), longest_.end(),
                       [](const Stretch& a, const Stretch& b) { return a.seconds > b.seconds; });
      longest_.resize(std::min(longest_.size(), kept));
    }
    last_ = time;
  }

  std::mutex mutex_;
  std::size_t stop_at_;
  std::size_t count_ = 0;
  double begin_ = 0;
  double last_ = 0;
  double total_ = 0;
  double stopped_ = 0;
  std::string step_ = "the beginning";
  std::vector<Stretch> longest_;
  std::vector<Shown> shown_;
};

} // namespace cagewright::test
