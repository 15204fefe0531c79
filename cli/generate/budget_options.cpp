#include "generate/arguments.h"

#include <charconv>
#include <map>
#include <string>
#include <string_view>

namespace cagewright::cli {
namespace {

/// "1%" and "0.01" as 0.01; 0 where it is neither.
double fraction_of(std::string_view text) {
  const bool is_percent = text.ends_with('%');
  text.remove_suffix(is_percent ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number ? (is_percent ? value / 100 : value) : 0;
}

} // namespace

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
  command
      .add_option("--faces", budget.improve.faces,
                  "The same for faces: triangles, or with --quads faces as written; both may be "
                  "given")
      ->check(CLI::Range(4, 200000))
      ->default_str("")
      ->each(asked)
      ->group(group);
  command
      .add_option_function<std::string>(
          "--max-gap", [&budget](const std::string& text) { budget.max_gap = fraction_of(text); },
          "Make the coarsest cage no point of which is farther from the model than this part of "
          "the model's diagonal, as 1% or 0.01; --vertices and --faces are then limits")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const double gap = fraction_of(text);
            return gap > 0 && gap <= 0.5 ? std::string()
                                         : text + " is not between 0 and 50%, such as 1% or 0.01";
          },
          "PERCENT"))
      ->each(asked)
      ->group(group);
  command
      .add_flag("--quads", arguments.options.quads,
                "Quads where they can be, none concave and none bent by more than 40 degrees; the "
                "cage is valid along both diagonals of each")
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
      ->each(asked)
      ->group(group);
  command
      .add_option("--envelope-resolution", budget.resolution,
                  "With --method envelope: voxels along the model's diagonal; 0: chosen by the "
                  "budget and the model")
      ->check(CLI::Range(0, 512))
      ->each(asked)
      ->group(group);
  command
      .add_option(
          "--density", arguments.density,
          "Where the cage is to be finer: a text or .npy file of one number for each vertex "
          "of the model (four times as much: edges half as long), or 'colors': where its "
          "vertex colors are red, and coarser where blue")
      ->option_text("FILE|colors")
      ->each(asked)
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
