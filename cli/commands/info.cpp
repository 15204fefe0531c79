#include "session.h"

namespace cagewright::cli {

void add_info(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("info", "Describe a model");
  command->callback([&session] { session.run = [] { return done; }; });
}

} // namespace cagewright::cli
