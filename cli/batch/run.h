/// \file
/// Cages for many models, each made by a run of this program of its own.
#pragma once

#include "generate/arguments.h"
#include "session.h"

#include <string>
#include <vector>

namespace cagewright::cli {

struct BatchArguments {
  std::vector<std::string> inputs; ///< folders, lists, patterns, models: see plan_batch()
  std::string out;
  std::string format = "obj"; ///< of the cages
  int jobs = 0;               ///< models at a time; 0: as many as there are cores
  bool retry = false;         ///< try again what has failed before
  GenerateArguments generate; ///< what is asked of each cage
};

/// Makes the cages. A model that fails, crashes, or takes too much time or memory keeps no other
/// from its cage. What an earlier run has made of the same file, options and program is kept.
/// \returns the exit code
int run_batch(const BatchArguments& arguments, const Session& session);

} // namespace cagewright::cli
