/// \file
/// Starting a program and hearing how it ends: the one place of the command line that depends on
/// the system for it.
#pragma once

#include <cagewright/core/result.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cagewright::cli {

/// The program that is running, as something that can be started.
std::filesystem::path this_program();

/// How a program ended.
struct ChildExit {
  int code = 0;   ///< what it returned; meaningless with a signal
  int signal = 0; ///< that ended it; 0: none did
  double cpu_seconds = 0;
  std::uint64_t peak_bytes = 0; ///< of memory, at its height
};

/// A program that was started by this one. Ctrl-C in the terminal does not reach it; when this
/// program dies, it is asked to stop.
class ChildProcess {
public:
  /// Starts a program. What it writes to its standard output is lost; of its standard error the end
  /// is kept.
  /// \param words  its command line, without its own name
  /// Errors: not_available.
  static Result<ChildProcess> start(const std::filesystem::path& program,
                                    const std::vector<std::string>& words);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ~ChildProcess(); ///< kills it if it runs still

  /// How it ended; nothing while it runs.
  std::optional<ChildExit> poll();
  /// The end of what it has said on its standard error.
  [[nodiscard]] const std::string& said() const;

  void ask_to_stop(); ///< as Ctrl-C would
  void kill();

  /// Returns when one of the programs may have ended or said something, at the latest after the
  /// time.
  static void wait_for_any(std::span<ChildProcess* const> children, std::chrono::milliseconds time);

private:
  struct State;
  explicit ChildProcess(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

} // namespace cagewright::cli
