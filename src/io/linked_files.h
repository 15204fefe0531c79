/// \file
/// What a model file needs beside it to look as it does.
#pragma once

#include <filesystem>
#include <vector>

namespace cagewright {

/// The files that a model file names and that exist beside it: material libraries of OBJ, images
/// of glTF, texture files that PLY names in a comment. Relative to the model's folder, each once,
/// in the order of the file. Buffers of glTF are not among them: rewrite_positions() writes those.
///
/// None for a file that cannot be read. Cost: a look at every line of text.
std::vector<std::filesystem::path> linked_files(const std::filesystem::path& model);

} // namespace cagewright
