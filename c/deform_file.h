/// \file
/// From files to files: a model, its cage, poses of that cage, and the model moved with each.
#pragma once

#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/point_cache.h>

#include <filesystem>
#include <vector>

namespace cagewright::c {

struct DeformedFiles {
  std::filesystem::path model;
  std::filesystem::path cage; ///< at rest, C vertices
  std::vector<std::filesystem::path> posed;
  std::vector<std::vector<Vec3>> positions; ///< without files of poses: C vertices in each
  std::vector<std::filesystem::path> outs;  ///< one that holds all the movement, or one for each
  CoordinateSettings coordinates;
  FrameTimes times;
};

/// Returns what was taken otherwise than it stands. Errors: those of reading, binding and writing;
/// mismatch (vertices of the cage and of a pose; numbers of poses and of files).
Result<std::vector<FileNote>> deform_files(const DeformedFiles& files, const Progress& progress);

} // namespace cagewright::c
