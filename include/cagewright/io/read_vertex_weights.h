/// \file
/// One number for each vertex of a model, from a file of its own.
#pragma once

#include <cagewright/core/result.h>

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace cagewright {

/// Reads weights: finite numbers that are not negative, in the order of the model's vertices.
///
///  - Text: one number to a line; empty lines and what follows a '#' are passed over.
///  - NumPy's .npy, told by its first bytes: an array of `count` numbers, or of one column of them,
///    of type float or integer with 1 to 8 bytes in the byte order of little-endian machines.
///
/// \param count  vertices of the model
/// Errors: cannot_open, too_large, malformed, mismatch (another number of weights). The message is
/// one line with the file, the line or the index (from 0), what is wrong and what helps.
Result<std::vector<double>> read_vertex_weights(const std::filesystem::path& path,
                                                std::size_t count);

/// The same for a file in memory; `name` stands for it in messages.
Result<std::vector<double>> read_vertex_weights(std::string_view bytes, std::string_view name,
                                                std::size_t count);

} // namespace cagewright
