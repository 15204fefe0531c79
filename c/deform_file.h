/// \file
/// Three files in, one out: a model that follows its cage.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>

#include <filesystem>
#include <vector>

namespace cagewright::c {

struct DeformedFiles {
  std::filesystem::path model;
  std::filesystem::path cage;  ///< at rest
  std::filesystem::path posed; ///< the same with its vertices moved
  std::filesystem::path out;   ///< none of the others
};

/// Deforms by mean value coordinates, as `cagewright deform` does.
/// \returns what was taken otherwise than it stands
/// Errors: those of reading, of match_pose() and of writing; invalid_cage, cancelled.
Result<std::vector<FileNote>> deform_file(const DeformedFiles& files, const Progress& progress);

} // namespace cagewright::c
