/// \file
/// What the command line of `generate` says.
///
/// To add an option of the cage: a member of GenerateOptions, and a line in the library's table of
/// options. What is no business of the library's is declared in cli/commands/generate.cpp.
#pragma once

#include "model_choice.h"

#include <cagewright/cage/option_table.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace cagewright::cli {

enum class Emit { cage, boxes, voxels };

struct GenerateArguments {
  std::vector<std::string> models; ///< one cage for all of them
  std::string output;
  std::string json;
  ModelChoice choice;
  Emit emit = Emit::cage;
  std::string start;      ///< a file with a cage of the user's own, or empty
  std::string joints;     ///< a file, or empty
  std::string density;    ///< a file, or "colors"; empty: even
  bool skin_cage = false; ///< the cage follows the model's joints
  GenerateOptions options;
  std::vector<const CageOption*> given; ///< options on the command line
  std::vector<std::string> words;       ///< the same as they stand there: "--max-gap=2%"
};

/// Declares all options of the library's table, under their names, in their groups.
void add_cage_options(CLI::App& command, GenerateArguments& arguments);

/// Options of the boxes without a method mean boxes: their union as it is, or improved if something
/// is asked for that the union does not heed.
void imply_method(GenerateArguments& arguments);

/// A sentence for each option on the command line that makes no difference. Each ends in a newline.
std::string without_effect(const GenerateArguments& arguments);

} // namespace cagewright::cli
