/// \file
/// Files that are complete or not there.
#pragma once

#include <cagewright/core/result.h>

#include <filesystem>
#include <string_view>

namespace cagewright {

/// Writes a file beside `path` and renames it when complete: whoever opens `path` finds either what
/// was there before or all of `bytes`, also when the disk is full or the program is killed.
///
/// A link is followed, and the permissions of a file that is replaced are kept. What is no file
/// but can be written, such as /dev/stdout or a pipe, is written directly.
///
/// Errors: cannot_write; nothing is left behind.
Status write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

} // namespace cagewright
