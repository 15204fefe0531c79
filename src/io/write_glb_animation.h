/// \file
/// A movement as the bytes of a GLB file.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/io/write_animation.h>

#include <filesystem>
#include <string>

namespace cagewright {

/// See write_animation(). `path` is for messages. Errors: unsupported (beyond 4 GB), cancelled.
Result<std::string> format_glb_animation(const MovingMesh& mesh, const std::filesystem::path& path,
                                         const Progress& progress = {});

} // namespace cagewright
