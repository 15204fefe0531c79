/// \file
/// Weights as text: CSV, JSON, DMAT, and groups of vertices. Internal to this module.
#pragma once

#include <cagewright/deform/weights_file.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

/// Takes the rows of a matrix of weights one block after the other.
class RowSink {
public:
  virtual ~RowSink() = default;
  /// P x K weights row by row, all rows of a block; the blocks follow one another.
  virtual Status rows(std::span<const float> block) = 0;
  /// Completes the file: it has its name from now on.
  virtual Status finish() = 0;
};

/// What weights are of and for.
struct WeightsIdentity {
  const CoordinateSettings& settings;
  const ColumnRule& rule;
  std::span<const Vec3> points;
  const PolygonMesh& cage;
};

/// "vertices=100 normals=196"
std::string text_of(const std::vector<ColumnGroup>& groups);

/// The kind and the options that a file names.
/// \param name  of the file, for the message
/// Errors: unsupported (no such kind or options).
Result<CoordinateSettings> settings_of_file(std::string_view kind, std::string_view options,
                                            const std::string& name);

/// How many columns such weights have for the cage that stands in the file.
/// \param columns  what the file says of them; empty: nothing
/// Errors: malformed (there can be none of this kind, or others).
Result<std::size_t> columns_of_file(const StoredWeights& stored, std::string_view columns,
                                    const std::string& name);

/// For all formats but npz. Errors: cannot_write, too_large (a format by columns whose matrix does
/// not fit memory_allowed()), unsupported (groups of vertices for columns that are none).
Result<std::unique_ptr<RowSink>> text_sink(WeightsFormat format, const WeightsIdentity& identity,
                                           const std::filesystem::path& path);

/// The format that the first bytes show: csv, json or dmat; none for others.
std::optional<WeightsFormat> text_weights_format(std::string_view bytes);

/// Reads what text_sink() has written; of DMAT files of other programs the numbers alone.
/// Errors: malformed, with the line where there is one; unsupported (groups of vertices).
Result<StoredWeights> read_text_weights(std::string_view bytes, WeightsFormat format,
                                        const std::string& name);

} // namespace cagewright
