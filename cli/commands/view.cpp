#include "session.h"

#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;

/// The application: beside this program, as installed; or where the build leaves it.
fs::path find_app() {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& path : {here / "cagewright-app", here / "../app/cagewright-app"}) {
    if (!here.empty() && fs::exists(path, error)) {
      return path;
    }
  }
  return "cagewright-app"; // as PATH says
}

int run(const std::vector<std::string>& files) {
  std::vector<std::string> arguments = {find_app().string()};
  arguments.insert(arguments.end(), files.begin(), files.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) {
    pointers.push_back(argument.data());
  }
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data()); // comes back only when it cannot
  return fail({ErrorCode::not_available,
               "the desktop application cagewright-app is not here; install the Qt 6 packages "
               "listed in ./dev and build again"});
}

} // namespace

void add_view(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("view", "Open the desktop application");
  const auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("FILES", *files, "A model or a project, and perhaps a cage")->expected(0, 2);
  command->callback([files, &session] { session.run = [files] { return run(*files); }; });
}

} // namespace cagewright::cli
