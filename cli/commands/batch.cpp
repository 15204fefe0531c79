#include "batch/run.h"
#include "session.h"

#include <memory>
#include <string>

namespace cagewright::cli {

void add_batch(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "batch", "Make cages for many models, as generate does for one, and go on where it stopped");
  const auto arguments = std::make_shared<BatchArguments>();
  GenerateArguments& asked = arguments->generate;
  command
      ->add_option(
          "MODELS", arguments->inputs,
          "Folders, patterns such as 'models/*.obj', lists (text files with a path in each "
          "line, - for the standard input) or models")
      ->required();
  command
      ->add_option("-o,--output", arguments->out,
                   "Folder for the cages, their reports (.json), and the tables batch.csv and "
                   "batch.json")
      ->required();
  command
      ->add_option(
          "-j,--jobs", arguments->jobs,
          "Models at a time; each uses --threads threads, of which the cores are shared out "
          "unless it is given; 0: as many as there are cores")
      ->check(CLI::Range(0, 1024));
  command->add_option("--format", arguments->format, "Format of the cages")
      ->check(CLI::IsMember({"obj", "ply", "off", "stl"}));
  command->add_flag("--retry", arguments->retry,
                    "Try again what has failed before with the same file and options");
  add_cage_options(*command, asked);
  add_pose_option(*command, asked.choice);
  add_only_option(*command, asked.choice, "Make the cages for these objects or groups");
  for (const char* name : {"--pose", "--only"}) {
    command->get_option(name)->group(std::string(title_of(OptionGroup::model)));
  }
  command
      ->add_option("--density", asked.density,
                   "Where the cages are to be finer: a file of weights in whose name * stands for "
                   "the model's, or 'colors': see generate")
      ->option_text("FILE|colors")
      ->group(std::string(title_of(OptionGroup::model)));
  command->footer(
      "--time-limit and --memory-limit are those of each model. The same command again "
      "makes what is missing, and what\nwas made of another file or with other options. "
      "Exit code 0: all cages are as asked for; 3: not all.\n\n"
      "Examples:\n"
      "  cagewright batch models -o cages --jobs 8 --vertices 80\n"
      "  cagewright batch 'scans/*.ply' -o cages --max-gap 2% --time-limit 10m\n"
      "  cagewright batch list.txt -o cages --quads --retry\n");
  command->callback([arguments, &session] {
    imply_method(arguments->generate);
    session.limits.is_for_each = true;
    session.run = [arguments, &session] { return run_batch(*arguments, session); };
  });
}

} // namespace cagewright::cli
