/// \file
/// Which models a batch is about, and where their cages go.
#pragma once

#include <cagewright/core/result.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cagewright::cli {

struct BatchJob {
  std::filesystem::path model;
  std::string name;             ///< of the model, as the table and messages have it
  std::filesystem::path cage;   ///< to be written
  std::filesystem::path report; ///< likewise: what `generate --json` says
};

/// Finds the models that the words mean, each once, in the order of the words and by name within
/// each: a model file itself; all model files in a folder and below it; those that a pattern with
/// * ? or [ matches; those that a list names, a text file with a path in each line, relative to the
/// list's own folder ("-": standard input, relative to the current one; # begins a comment).
///
/// A cage keeps the place of its model below the folder that all of them share, and its name;
/// where two would get the same, their former extensions stay: "a.off.obj".
///
/// \param out        folder for the cages; models in it are passed over
/// \param extension  of the cages: ".obj"
/// Errors: cannot_open (no such file, or no model found), invalid_option.
Result<std::vector<BatchJob>> plan_batch(const std::vector<std::string>& words,
                                         const std::filesystem::path& out,
                                         const std::string& extension);

} // namespace cagewright::cli
