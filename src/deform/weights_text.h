/// \file
/// Weights as text: CSV, JSON, DMAT, and groups of vertices. Internal to this module.
#pragma once

#include <cagewright/deform/weights_file.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace cagewright {

/// Takes the rows of a matrix of weights one block after the other.
class RowSink {
public:
  virtual ~RowSink() = default;
  /// P x C weights row by row, all rows of a block; the blocks follow one another.
  virtual Status rows(std::span<const float> block) = 0;
  /// Completes the file: it has its name from now on.
  virtual Status finish() = 0;
};

/// For all formats but npz. Errors: cannot_write, too_large (a format by columns whose matrix does
/// not fit memory_allowed()).
Result<std::unique_ptr<RowSink>> text_sink(WeightsFormat format, std::span<const Vec3> points,
                                           const PolygonMesh& cage,
                                           const std::filesystem::path& path);

/// The format that the first bytes show: csv, json or dmat; none for others.
std::optional<WeightsFormat> text_weights_format(std::string_view bytes);

/// Reads what text_sink() has written; of DMAT files of other programs the numbers alone.
/// Errors: malformed, with the line where there is one; unsupported (groups of vertices).
Result<StoredWeights> read_text_weights(std::string_view bytes, WeightsFormat format,
                                        const std::string& name);

} // namespace cagewright
