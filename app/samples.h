/// \file
/// Models that come with the program, to try it with.
#pragma once

#include <cagewright/core/result.h>

#include <filesystem>

namespace cagewright::app {

struct SampleFiles {
  std::filesystem::path model;
  std::filesystem::path cage; ///< valid for the model
};

/// Puts the sample model and its cage into a folder, so that they can be opened like any other;
/// files that are there already and differ are replaced. Errors: cannot_write.
Result<SampleFiles> sample_files(const std::filesystem::path& folder);

/// The same in the user's folder of the program's data.
Result<SampleFiles> sample_files();

} // namespace cagewright::app
