#include "run_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

// A sanitizer's own tables would be refused.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CAGEWRIGHT_OWN_MEMORY_MAP 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) ||                         \
    __has_feature(memory_sanitizer)
#define CAGEWRIGHT_OWN_MEMORY_MAP 1
#endif
#endif

namespace cagewright::cli {
namespace {

constexpr double kilo = 1024;
constexpr double usual_share = 0.8; // of the machine's memory: the rest keeps the desktop alive

/// What this machine has, or the container we run in.
double machine_memory() {
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  double bytes = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  double group = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> group && group > 0) { // "max" is no number
    bytes = std::min(bytes, group);
  }
  return bytes;
}

/// A number, and the unit after it.
struct Quantity {
  double value;
  std::string_view unit;
};

std::optional<Quantity> quantity_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value >= 0) || !std::isfinite(value)) {
    return std::nullopt;
  }
  std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
  return Quantity{value, unit};
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

std::optional<double> unit_factor(const std::vector<std::pair<const char*, double>>& units,
                                  std::string_view unit) {
  for (const auto& [name, factor] : units) {
    if (lower(unit) == name) {
      return factor;
    }
  }
  return std::nullopt;
}

std::string parse_seconds(const std::string& text, double& seconds) {
  const auto quantity = quantity_of(text);
  const auto factor =
      quantity
          ? unit_factor({{"", 1}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}}, quantity->unit)
          : std::nullopt;
  if (!factor) {
    return text + " is no time; give seconds, or a number with s, m or h, such as 10m";
  }
  seconds = quantity->value * *factor;
  return {};
}

std::string parse_bytes(const std::string& text, std::uint64_t& bytes) {
  const auto quantity = quantity_of(text);
  const auto factor = quantity ? unit_factor({{"", 1},
                                              {"b", 1},
                                              {"k", kilo},
                                              {"kb", kilo},
                                              {"kib", kilo},
                                              {"m", kilo * kilo},
                                              {"mb", kilo * kilo},
                                              {"mib", kilo * kilo},
                                              {"g", kilo * kilo * kilo},
                                              {"gb", kilo * kilo * kilo},
                                              {"gib", kilo * kilo * kilo},
                                              {"t", kilo * kilo * kilo * kilo},
                                              {"tb", kilo * kilo * kilo * kilo},
                                              {"%", machine_memory() / 100}},
                                             quantity->unit)
                               : std::nullopt;
  if (!factor) {
    return text + " is no amount of memory; give a number with M, G or %, such as 4G or 50%";
  }
  const double value = std::min(quantity->value * *factor,
                                static_cast<double>(std::numeric_limits<std::int64_t>::max()));
  bytes = static_cast<std::uint64_t>(value);
  return {};
}

} // namespace

void add_limit_options(CLI::App& app, Limits& limits) {
  limits.bytes = static_cast<std::uint64_t>(usual_share * machine_memory());
  app.add_option_function<std::string>(
         "--time-limit",
         [&limits](const std::string& text) {
           if (const std::string wrong = parse_seconds(text, limits.seconds); !wrong.empty()) {
             throw CLI::ValidationError("--time-limit", wrong);
           }
         },
         "Stop with exit code 4 after so many seconds, or minutes (10m), or hours (2h); 0: never")
      ->option_text("TIME=1h");
  app.add_option_function<std::string>(
         "--memory-limit",
         [&limits](const std::string& text) {
           if (const std::string wrong = parse_bytes(text, limits.bytes); !wrong.empty()) {
             throw CLI::ValidationError("--memory-limit", wrong);
           }
           limits.is_memory_given = true;
         },
         "Stop with exit code 4 rather than use more memory: 4G, 500M, 50%; 0: no limit")
      ->option_text("BYTES=80%");
}

std::string bytes_as_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  return value >= kilo * kilo * kilo ? fmt::format("{:.1f} GB", value / (kilo * kilo * kilo))
                                     : fmt::format("{:.0f} MB", value / (kilo * kilo));
}

std::string seconds_as_text(double seconds) {
  if (seconds >= 3600 && std::fmod(seconds, 3600) == 0) {
    return fmt::format("{:g} h", seconds / 3600);
  }
  return seconds >= 120 && std::fmod(seconds, 60) == 0 ? fmt::format("{:g} min", seconds / 60)
                                                       : fmt::format("{:g} s", seconds);
}

void limit_memory(std::uint64_t bytes) {
#ifndef CAGEWRIGHT_OWN_MEMORY_MAP
  struct rlimit limit {};
  if (bytes > 0 && getrlimit(RLIMIT_DATA, &limit) == 0 && bytes < limit.rlim_cur) {
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_DATA, &limit);
  }
#endif
}

Deadline::Deadline(double seconds, std::function<void()> expired, std::function<void()> overdue) {
  constexpr double forever = 1e9; // beyond what clocks can count
  if (!(seconds > 0 && seconds < forever)) {
    return;
  }
  // Work that looks for the sign to stop every tenth of a second or so gets time to tidy up.
  const double grace = std::max(3.0, seconds / 10);
  thread_ = std::thread(
      [this, seconds, grace, expired = std::move(expired), overdue = std::move(overdue)] {
        if (wait(std::chrono::duration<double>(seconds))) {
          return;
        }
        expired();
        while (!wait(std::chrono::duration<double>(grace))) {
          overdue();
        }
      });
}

Deadline::~Deadline() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
}

bool Deadline::wait(std::chrono::duration<double> time) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, time, [this] { return over_; });
}

} // namespace cagewright::cli
