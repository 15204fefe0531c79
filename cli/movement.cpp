#include "movement.h"

#include "load.h"

#include <cagewright/deform/write_movement.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

namespace cagewright::cli {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The digits at the beginning, without zeros in front; `text` goes on after them.
std::string_view take_number(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

} // namespace

void add_time_options(CLI::App& command, FrameTimes& times) {
  command.add_option("--fps", times.frames_per_second, "Frames a second of a movement in one file")
      ->check(CLI::Range(0.001, 10000.0));
  command
      .add_option("--first-frame", times.first_frame,
                  "The number of the first deformed cage in a point cache")
      ->check(CLI::Range(-1e6, 1e6));
}

bool is_one_movement(const std::string& output, std::size_t poses) {
  return output.find('*') == std::string::npos && !std::filesystem::is_directory(output) &&
         holds_movement(output, poses);
}

bool comes_before(std::string_view one, std::string_view other) {
  const std::pair whole{one, other};
  while (!one.empty() && !other.empty()) {
    if (is_digit(one.front()) && is_digit(other.front())) {
      const std::string_view a = take_number(one);
      const std::string_view b = take_number(other);
      if (a.size() != b.size() || a != b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
      }
    } else if (one.front() != other.front()) {
      return one.front() < other.front();
    } else {
      one.remove_prefix(1);
      other.remove_prefix(1);
    }
  }
  // (Names that differ in zeros alone, so that the order is total.)
  return one.empty() != other.empty() ? one.empty() : whole.first < whole.second;
}

void in_order_of_frames(std::vector<std::string>& names) {
  if (std::ranges::is_sorted(names) && !std::ranges::is_sorted(names, comes_before)) {
    std::ranges::sort(names, comes_before);
    const FileNote note{"frames_sorted",
                        fmt::format("the deformed cages are taken in the order of their numbers: "
                                    "first {}, last {}",
                                    names.front(), names.back())};
    tell({&note, 1});
  }
}

} // namespace cagewright::cli
