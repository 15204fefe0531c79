#include "describe.h"
#include "interruption.h"
#include "json.h"
#include "session.h"

#include "core/arena.h"
#include "io/atomic_file.h"
#include "io/source.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/version.h>

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <string_view>
#include <system_error>

namespace {

using namespace cagewright;
using namespace cagewright::cli;

constexpr std::string_view json_option = "--json";

constexpr const char* exit_codes = R"(Exit codes:
  0    all that was asked holds
  1    check, or --strict: the cage is not valid for the model
  2    misused options, or files that cannot be read or written
  3    the input is fine, but what is asked cannot be had
  4    the limit of time or memory is reached
  130  stopped by Ctrl-C or another signal)";

void ignore_signals() {
  // Whoever reads our output may stop doing so; the files are written nevertheless.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

Error out_of_memory(const Session& session) {
  return {ErrorCode::too_large,
          fmt::format("not enough memory: the limit is {}; use a lower --resolution, fewer "
                      "vertices or a smaller model, or allow more with --memory-limit",
                      session.limits.bytes > 0 ? bytes_as_text(session.limits.bytes)
                                               : std::string("that of the machine"))};
}

/// For exceptions that nobody can catch, such as those of threads without memory.
[[noreturn]] void end_badly() {
  static constexpr const char* no_memory =
      "cagewright: not enough memory; allow more with --memory-limit\n";
  static constexpr const char* unknown = "cagewright: internal error\n";
  const char* text = unknown;
  int code = not_satisfiable;
  try {
    if (const std::exception_ptr thrown = std::current_exception()) {
      std::rethrow_exception(thrown);
    }
  } catch (const std::bad_alloc&) {
    text = no_memory;
    code = limit_reached;
  } catch (const std::system_error&) { // a thread without room for its stack
    text = no_memory;
    code = limit_reached;
  } catch (...) {
  }
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(code);
}

std::string version_text() {
  return fmt::format("cagewright {}\nfeatures: {}\ncoordinates: {}\nlicence: {}\n"
                     "Cages, weights and deformed models are yours: no licence covers them.",
                     CAGEWRIGHT_VERSION, CAGEWRIGHT_FEATURES, names_of_coordinate_kinds(),
                     CAGEWRIGHT_LICENCE);
}

int run(Session& session) {
  try {
    tbb::task_arena arena(arena_slots(session.threads));
    return arena.execute(session.run);
  } catch (const std::bad_alloc&) {
    return fail(out_of_memory(session));
  } catch (const std::filesystem::filesystem_error& e) { // a name that is too long, a dead disk
    return fail(cannot_write(e.path1(), e.code().value()));
  } catch (const std::system_error&) { // a thread without room for its stack
    return fail(out_of_memory(session));
  } catch (const std::exception& e) {
    return fail({ErrorCode::no_valid_cage, std::string("internal error: ") + e.what()});
  }
}

/// --json names a file that the command line names elsewhere, too: perhaps one that is read.
bool is_named_twice(const Session& session) {
  const auto is_json = [&](const std::string& word) {
    std::error_code none;
    return word == session.json || std::filesystem::equivalent(word, session.json, none);
  };
  const auto count = std::count_if(session.words.begin() + 1, session.words.end(), is_json);
  const bool is_word =
      std::find(session.words.begin(), session.words.end(), json_option) != session.words.end();
  return count > (is_word ? 1 : 0);
}

/// With --json a failure is told there, too.
void tell_in_json(const Session& session, const nlohmann::json& failure, int exit_code) {
  if (!session.json.empty() && !is_named_twice(session)) {
    // Should that fail as well, the message on stderr must do.
    (void)write_json(session.json, {{"format", "cagewright-error"},
                                    {"version", 1},
                                    {"exit_code", exit_code},
                                    {"error", failure}});
  }
}

std::string_view code_of(const Session& session, const Error& error) {
  return error.code == ErrorCode::cancelled && session.out_of_time ? "time_limit"
                                                                   : name_of(error.code);
}

/// What is left in the standard output's buffer may not fit the disk.
int flush_output(int exit_code) {
  const bool failed_before = std::ferror(stdout) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !failed_before) {
    return exit_code;
  }
  if (errno != EPIPE) { // a pipe that was closed is a reader that has seen enough
    std::fprintf(stderr, "cagewright: the standard output cannot be written: %s\n",
                 errno != 0 ? std::strerror(errno) : "output is missing");
  }
  return exit_code == done ? bad_input : exit_code;
}

/// The word after --json, also on a command line that cannot be parsed.
std::string json_of_command_line(const std::vector<std::string>& words) {
  for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    if (words[i] == json_option && i + 1 < words.size()) {
      return words[i + 1];
    }
    if (words[i].starts_with(json_option) && words[i].substr(json_option.size()).starts_with("=")) {
      return words[i].substr(json_option.size() + 1);
    }
  }
  return {};
}

/// With --json, the failure that was told last.
void tell_failure_in_json(const Session& session, int exit_code) {
  if (session.first_failure) {
    tell_in_json(session,
                 json_of_failure(code_of(session, *session.first_failure),
                                 session.first_failure->message, session.words),
                 exit_code);
  }
}

/// Ends the program in the middle of whatever it is doing. Files that are not complete go. Once
/// files are written it is likely to be about to end by itself, and gets a little longer for that.
void end_at_once(Session& session) {
  if (has_written_files() && !session.is_overdue.exchange(true)) {
    return;
  }
  const int exit_code = fail(Error::cancelled());
  tell_failure_in_json(session, exit_code);
  abandon_part_files();
  ::_exit(exit_code);
}

/// What is wrong with a command line that names no command but something else; empty: it is another
/// thing.
std::string unknown_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (!app.get_subcommands().empty() || words.empty() || words.front().starts_with("-")) {
    return {};
  }
  std::string known;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) {
      known += (known.empty() ? "" : ", ") + command->get_name();
    }
  }
  return fmt::format("there is no command {}; there are {}", in_quotes(words.front()), known);
}

int run_command_line(Session& session, CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (const std::string what = unknown_command(app); !what.empty() && e.get_exit_code() != 0) {
      fmt::print(stderr, "cagewright: {}\n", what);
      tell_in_json(session, json_of_failure("misuse", what, {}), bad_input);
      return bad_input;
    }
    if (app.exit(e) == 0) {
      return done; // --help, --version
    }
    tell_in_json(session, json_of_failure("misuse", e.what(), {}), bad_input);
    return bad_input;
  }
  // A batch ends when its models have, which it asks to stop.
  const bool has_others = session.limits.is_for_each;
  const Interruption interruption(
      session.stop, has_others ? std::function<void()>() : [&session] { end_at_once(session); });
  const Limits limits = session.limits.is_for_each ? Limits{.seconds = 0} : session.limits;
  const Deadline deadline(
      limits.seconds,
      [&session] {
        session.out_of_time = true;
        session.stop.request_stop();
      },
      [&session] { end_at_once(session); });
  limit_memory(limits.bytes);
  const int exit_code = run(session);
  if (exit_code != done) {
    tell_failure_in_json(session, exit_code);
  }
  return exit_code;
}

} // namespace

int main(int argc, char** argv) {
  std::set_terminate(end_badly);
  Session session;
  session.words.assign(argv, argv + argc);
  session.json = json_of_command_line(session.words);
  session.begin();
  CLI::App app("Builds a cage round a 3D model and deforms the model with it.", "cagewright");
  app.set_version_flag("--version", version_text, "Print version, features and licence, and exit");
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  app.add_option("--threads", session.threads, "Threads to use; 0 means all cores")
      ->check(CLI::Range(0, 1024));
  app.add_flag("-q,--quiet", session.quiet, "Print nothing but errors");
  add_limit_options(app, session.limits);
  app.footer(exit_codes);
  app.fallthrough(); // --threads and --quiet may also follow the command
#define CAGEWRIGHT_ADD(name) add_##name(app, session);
  CAGEWRIGHT_COMMANDS(CAGEWRIGHT_ADD)
#undef CAGEWRIGHT_ADD
  add_describe(app, session);
  ignore_signals();
  return flush_output(run_command_line(session, app, argc, argv));
}
