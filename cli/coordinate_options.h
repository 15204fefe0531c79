/// \file
/// The options --coordinates NAME and those of each kind, the same in every command.
#pragma once

#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/result.h>
#include <cagewright/deform/weights_file.h>

#include <CLI/CLI.hpp>

#include <list>
#include <string>
#include <string_view>

namespace cagewright::cli {

/// What the command line says of coordinates.
struct CoordinateArguments {
  struct Value {
    const CoordinateOption* option = nullptr;
    std::string text;
    const CLI::Option* given = nullptr;
  };

  std::string kind = std::string(CoordinateSettings().kind().name);
  const CLI::Option* given = nullptr;
  std::list<Value> values; // a list: CLI11 keeps references to the texts
  std::string mix;         ///< another kind, or empty
  std::string mix_weights; ///< where its share of each vertex stands, see shares_of_mix()
};

/// The word for the kind that carries the model best.
constexpr std::string_view best_kind = "auto";

/// Declares --coordinates and the options of all kinds.
/// \param offer_best  --coordinates auto is allowed, too: see chosen_settings()
void add_coordinate_options(CLI::App& command, CoordinateArguments& arguments,
                            bool offer_best = false);

/// Declares --mix and --mix-weights.
void add_mix_options(CLI::App& command, CoordinateArguments& arguments);

/// What was asked for. Warns of options that the kind does not have.
/// Errors: invalid_option.
Result<CoordinateSettings> settings_of(const CoordinateArguments& arguments);

/// Reconciles weights that were read with the command line: options for posing are taken from it,
/// others must agree; weights that do not say of which kind they are are taken as asked for.
/// Errors: mismatch, invalid_option.
Status take_settings(const CoordinateArguments& arguments, StoredWeights& stored);

} // namespace cagewright::cli
