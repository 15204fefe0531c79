/// \file
/// What every command shares: where to talk, how to stop, which exit code says what.
#pragma once

#include "run_limits.h"

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <CLI/CLI.hpp>

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright::cli {

enum ExitCode : int {
  done = 0,            ///< all that was asked holds
  found_faults = 1,    ///< a cage that was to be judged is not valid
  bad_input = 2,       ///< misused options, or files that cannot be read or written
  not_satisfiable = 3, ///< the input was fine, but what is asked cannot be had
  limit_reached = 4,   ///< of time or memory
  interrupted = 130,   ///< stopped by Ctrl-C or another signal
};

/// One run of the program. A command's parser callback sets `run`; main() calls it.
struct Session {
  std::function<int()> run;
  StopFlag stop;
  int threads = 0;    ///< 0: all cores
  bool quiet = false; ///< no progress and no summary on the terminal
  Limits limits;
  std::atomic<bool> out_of_time = false;      ///< `stop` was asked for by the time limit
  std::atomic<bool> is_overdue = false;       ///< it should have stopped, and was given longer
  std::vector<std::string> words;             ///< the command line, for the files that errors name
  std::string json;                           ///< the file of --json; empty: not asked for
  mutable std::optional<Error> first_failure; ///< as fail() was told

  /// Shows a line of progress on stderr when that is a terminal; stops on Ctrl-C.
  [[nodiscard]] Progress progress() const;

  /// A result for people, unless they want quiet: on stdout, or on stderr where --json - has
  /// taken stdout.
  void say(std::string_view text) const;

  /// Makes this the run that fail() speaks of. There is one a process.
  void begin();
};

/// Prints "cagewright: <message>" on stderr and returns the exit code that goes with the error.
int fail(const Error& error);

/// The exit code that goes with an error.
ExitCode exit_code_of(const Error& error);

/// Prints "cagewright: warning: <message>" on stderr.
void warn(std::string_view message);

#ifdef CAGEWRIGHT_HAS_RENDER
#define CAGEWRIGHT_RENDER_COMMAND(X) X(render)
#else
#define CAGEWRIGHT_RENDER_COMMAND(X)
#endif

// One function for each command, in cli/commands/<name>.cpp: it declares the options and what to
// run. The order is that of --help.
#define CAGEWRIGHT_COMMANDS(X)                                                                     \
  X(generate)                                                                                      \
  X(batch)                                                                                         \
  X(check)                                                                                         \
  X(compare)                                                                                       \
  X(info) X(bind) X(deform) X(coordinates) X(convert) X(weld) CAGEWRIGHT_RENDER_COMMAND(X) X(view)
#define CAGEWRIGHT_DECLARE(name) void add_##name(CLI::App& app, Session& session);
CAGEWRIGHT_COMMANDS(CAGEWRIGHT_DECLARE)
#undef CAGEWRIGHT_DECLARE

} // namespace cagewright::cli
