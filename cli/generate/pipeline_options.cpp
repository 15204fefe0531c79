#include "generate/arguments.h"

#include <map>
#include <string>

namespace cagewright::cli {

void add_pipeline_options(CLI::App& command, BoxCageOptions& options) {
  const char* group = "Pipeline";
  command
      .add_option("--resolution", options.boxes.resolution,
                  "Voxels along the longest axis of the model's box")
      ->check(CLI::Range(8, 512))
      ->group(group);
  command
      .add_option_function<std::string>(
          "--registration",
          [&options](const std::string& how) { options.registration = how == "on"; },
          "Join the faces of neighbouring boxes where they fit")
      ->check(CLI::IsMember({"on", "off"}))
      ->default_str("on")
      ->group(group);
  command
      .add_option(
          "--pieces", options.boxes.pieces,
          "A model in several pieces gets one cage with thin bridges (together), or one for "
          "each group of pieces that are apart (apart)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Pieces>{{"together", Pieces::together}, {"apart", Pieces::apart}}))
      ->default_str("together")
      ->group(group);
}

} // namespace cagewright::cli
