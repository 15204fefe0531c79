#include "generate/arguments.h"
#include "generate/run.h"
#include "session.h"

#include <map>
#include <memory>
#include <string>

namespace cagewright::cli {

void add_generate(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("generate", "Make a valid cage for a model");
  const auto arguments = std::make_shared<GenerateArguments>();
  command->add_option("MODEL", arguments->model, "OBJ, PLY, STL, OFF, GLB or glTF file")
      ->required();
  command->add_option("-o,--output", arguments->output, "OBJ, PLY, STL or OFF file to write")
      ->required();
  command->add_option("--json", arguments->json,
                      "File for all figures: every box, axis, cross-section and cut");
  command
      ->add_option("--emit", arguments->emit,
                   "What to write: the cage, the boxes (one object each), or the voxels")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Emit>{
          {"cage", Emit::cage}, {"boxes", Emit::boxes}, {"voxels", Emit::voxels}}))
      ->default_str("cage");
  add_slicing_options(*command, arguments->options.boxes.slicing);
  add_pipeline_options(*command, arguments->options);
  add_budget_options(*command, *arguments);
  command->callback([arguments, &session] {
    session.run = [arguments, &session] { return run_generate(*arguments, session); };
  });
}

} // namespace cagewright::cli
