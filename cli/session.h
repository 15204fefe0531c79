/// \file
/// What every command shares: where to talk, how to stop, which exit code says what.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace cagewright::cli {

enum ExitCode : int {
  done = 0,          ///< the command did what was asked
  could_not = 1,     ///< the input was fine, the answer is no: an invalid cage, no cage found
  bad_input = 2,     ///< misused options, or files that cannot be read or written
  not_as_asked = 3,  ///< a valid result is written, but not all that was asked for holds
  interrupted = 130, ///< stopped by Ctrl-C
};

/// One run of the program. A command's parser callback sets `run`; main() calls it.
struct Session {
  std::function<int()> run;
  StopFlag stop;
  int threads = 0;    ///< 0: all cores
  bool quiet = false; ///< no progress and no summary on the terminal

  /// Shows a line of progress on stderr when that is a terminal; stops on Ctrl-C.
  [[nodiscard]] Progress progress() const;
};

/// Prints "cagewright: <message>" on stderr and returns the exit code that goes with the error.
int fail(const Error& error);

#ifdef CAGEWRIGHT_HAS_RENDER
#define CAGEWRIGHT_RENDER_COMMAND(X) X(render)
#else
#define CAGEWRIGHT_RENDER_COMMAND(X)
#endif

// One function for each command, in cli/commands/<name>.cpp: it declares the options and what to
// run. The order is that of --help.
#define CAGEWRIGHT_COMMANDS(X)                                                                     \
  X(generate)                                                                                      \
  X(check) X(compare) X(info) X(bind) X(deform) X(convert) CAGEWRIGHT_RENDER_COMMAND(X) X(view)
#define CAGEWRIGHT_DECLARE(name) void add_##name(CLI::App& app, Session& session);
CAGEWRIGHT_COMMANDS(CAGEWRIGHT_DECLARE)
#undef CAGEWRIGHT_DECLARE

} // namespace cagewright::cli
