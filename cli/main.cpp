#include "session.h"

#include <cagewright/version.h>

#include <tbb/task_arena.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

namespace {

using namespace cagewright;
using namespace cagewright::cli;

// A signal handler can reach nothing but a global; the handler's thread asks the session to stop.
StopFlag* interrupt_target = nullptr;

void interrupt(int /*signal*/) {
  if (interrupt_target != nullptr) {
    interrupt_target->request_stop();
  }
  std::signal(SIGINT, SIG_DFL); // a second Ctrl-C ends the program at once
}

constexpr const char* version_text = "cagewright " CAGEWRIGHT_VERSION
#if CAGEWRIGHT_WITH_BOXES
                                     "\nwith the union of boxes; licence: GPL-3.0-or-later";
#else
                                     "\nwithout the union of boxes; licence: MIT";
#endif

int run(Session& session) {
  try {
    tbb::task_arena arena(session.threads > 0 ? session.threads : tbb::task_arena::automatic);
    return arena.execute(session.run);
  } catch (const std::bad_alloc&) {
    return fail({ErrorCode::too_large,
                 "not enough memory; use a lower --resolution, or a model with fewer faces"});
  } catch (const std::exception& e) {
    return fail({ErrorCode::no_valid_cage, std::string("internal error: ") + e.what()});
  }
}

} // namespace

int main(int argc, char** argv) {
  Session session;
  CLI::App app("Builds a cage round a 3D model and deforms the model with it.", "cagewright");
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  app.add_option("--threads", session.threads, "Threads to use; 0 means all cores")
      ->check(CLI::Range(0, 1024));
  app.add_flag("-q,--quiet", session.quiet, "Print nothing but errors");
  app.fallthrough(); // --threads and --quiet may also follow the command
#define CAGEWRIGHT_ADD(name) add_##name(app, session);
  CAGEWRIGHT_COMMANDS(CAGEWRIGHT_ADD)
#undef CAGEWRIGHT_ADD

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? done : bad_input;
  }
  interrupt_target = &session.stop;
  std::signal(SIGINT, interrupt);
  return run(session);
}
