/// \file
/// What the command line of `generate` says, and its groups of options.
///
/// To add an option: a member of the library's own options struct, or of GenerateArguments if it is
/// none of the library's business; its declaration in the group it belongs to,
/// cli/generate/<group>_options.cpp; what the result says of it in report.cpp.
#pragma once

#include "cage/box_cage.h"
#include "cage/budget_cage.h"

#include <CLI/CLI.hpp>

#include <string>

namespace cagewright::cli {

enum class Emit { cage, boxes, voxels };

struct GenerateArguments {
  std::string model;
  std::string output;
  std::string json;
  Emit emit = Emit::cage;
  BoxCageOptions options;   ///< of the union of the boxes
  bool has_budget = false;  ///< an option asks for more than the union of the boxes
  int vertices = 0;         ///< 0: not given
  std::string density;      ///< a file, or "colors"; empty: even
  BudgetCageOptions budget; ///< of the cage within a budget; its `boxes` are set by run_generate()
};

/// --depth, --boxes, --slicing and the rest: slicing_options.cpp
void add_slicing_options(CLI::App& command, SlicingOptions& slicing);

/// --resolution, --registration, --pieces: pipeline_options.cpp
void add_pipeline_options(CLI::App& command, BoxCageOptions& options);

/// --vertices, --faces, --max-gap, --method, --clearance and the rest: budget_options.cpp
void add_budget_options(CLI::App& command, GenerateArguments& arguments);

} // namespace cagewright::cli
