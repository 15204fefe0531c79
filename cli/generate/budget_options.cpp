#include "generate/arguments.h"

#include <map>
#include <string>

namespace cagewright::cli {

void add_budget_options(CLI::App& command, GenerateArguments& arguments) {
  const char* group = "Budget";
  BudgetCageOptions& budget = arguments.budget;
  budget.symmetry = Symmetry::automatic;
  const auto asked = [&arguments](const auto&) { arguments.has_budget = true; };
  command
      .add_option("--vertices", arguments.vertices,
                  "Make the best cage of at most so many vertices (100, if another option of this "
                  "group is given, and not --faces)")
      ->check(CLI::Range(4, 100000))
      ->default_str("")
      ->each(asked)
      ->group(group);
  command.add_option("--faces", budget.improve.faces, "The same for triangles; both may be given")
      ->check(CLI::Range(4, 200000))
      ->default_str("")
      ->each(asked)
      ->group(group);
  command
      .add_option("--method", budget.start,
                  "What a cage within a budget is made from: envelope, a surface of voxels of any "
                  "topology; or obb, the union of the boxes")
      ->transform(CLI::CheckedTransformer(std::map<std::string, CageStart>{
          {"envelope", CageStart::envelope}, {"obb", CageStart::obb}}))
      ->default_str("envelope")
      ->each(asked)
      ->group(group);
  command
      .add_option("--clearance", budget.improve.clearance,
                  "Least distance between cage and model, as a fraction of the model's diagonal")
      ->check(CLI::Range(1e-6, 0.5))
      ->each(asked)
      ->group(group);
  command
      .add_option(
          "--closing", budget.closing,
          "With --method envelope: fill holes and gaps narrower than twice this fraction of "
          "the model's diagonal")
      ->check(CLI::Range(0.0, 0.5))
      ->group(group);
  command
      .add_option("--envelope-resolution", budget.resolution,
                  "With --method envelope: voxels along the model's diagonal; 0: chosen by the "
                  "budget and the model")
      ->check(CLI::Range(0, 512))
      ->group(group);
  command
      .add_option(
          "--symmetry", budget.symmetry,
          "Make the cage its own mirror image, vertex by vertex: auto, if the model is, in "
          "whatever plane; x, y or z, in the best plane across that axis, even if the model "
          "is not; off")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, Symmetry>{{"auto", Symmetry::automatic},
                                                                  {"x", Symmetry::x},
                                                                  {"y", Symmetry::y},
                                                                  {"z", Symmetry::z},
                                                                  {"off", Symmetry::off}}))
      ->default_str("auto")
      ->each(asked)
      ->group(group);
}

} // namespace cagewright::cli
