/// \file
/// The parts of a glTF file below the scene: container, JSON, buffers and accessors.
#pragma once

#include "io/read_file.h"
#include "io/source.h"
#include <cagewright/core/result.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

// nlohmann's parser with checked access on top, not tinygltf: that one loads images and materials
// which are of no use here, and reads what an accessor says without asking whether it can be true.
using Json = nlohmann::json;

/// The member of an object, or null where there is none or `object` is no object.
const Json& member(const Json& object, const char* key);

/// The element of an array, or null where there is none or `array` is no array.
const Json& element(const Json& array, std::size_t index);

/// A non-negative whole number up to 2^53, also when it is written as 3.0; none for anything else.
std::optional<std::size_t> to_size(const Json& value);

/// The text, or an empty one for anything else.
std::string to_text(const Json& value);

/// A glTF file, its buffers loaded on demand.
class GltfDocument {
public:
  /// Opens the container and parses the JSON. Buffers in other files are looked for in `folder`;
  /// without one they are refused.
  static Result<GltfDocument> open(const Source& source,
                                   std::optional<std::filesystem::path> folder);

  [[nodiscard]] const Json& json() const { return json_; }
  [[nodiscard]] const Source& source() const { return source_; }

  /// Reads an accessor of N components per element, as doubles (normalized integers as fractions).
  /// Sparse values are applied. Errors: malformed, unsupported, cannot_open.
  Result<std::vector<double>> read_vectors(std::size_t accessor, std::size_t components);

  /// Reads an accessor of unsigned integers.
  Result<std::vector<std::uint32_t>> read_indices(std::size_t accessor);

  /// Where the floats of an accessor lie.
  struct Place {
    std::size_t buffer = 0;
    std::size_t begin = 0;  ///< of the first element, in the buffer
    std::size_t stride = 0; ///< from one element to the next
    std::size_t count = 0;
  };

  /// The place of an accessor of floats whose values can be changed where they are; none where they
  /// are stored otherwise (as integers, sparse, or not at all), or where other accessors hold some
  /// of the same bytes. Errors: those of read_vectors().
  Result<std::optional<Place>> place_of(std::size_t accessor, std::size_t components);

  /// A buffer to be changed or made longer; later reads see the changes.
  std::string& changeable_buffer(std::size_t index);

  /// Makes room for buffers that the JSON does not name yet.
  void reserve_buffers(std::size_t count) { loaded_.resize(std::max(loaded_.size(), count)); }

  /// The bytes of a buffer with those beyond its promised length.
  std::string_view whole_buffer(std::size_t index) { return changeable_buffer(index); }

  /// Another JSON instead of the file's, for the same buffers and new ones behind them, which
  /// changeable_buffer() fills. json_text() stays that of the file. Errors: malformed.
  Status replace_json(std::string_view text);

  /// The JSON as it stands in the file, and the binary chunk of a GLB file.
  [[nodiscard]] std::string_view json_text() const { return json_text_; }
  [[nodiscard]] std::string_view binary_chunk() const { return binary_chunk_; }
  /// All chunks of a GLB file in their order; none for JSON alone.
  struct Chunk {
    std::string_view type; ///< "JSON", "BIN\0" or another of four bytes
    std::string_view content;
  };
  [[nodiscard]] const std::vector<Chunk>& chunks() const { return chunks_; }
  [[nodiscard]] const std::optional<std::filesystem::path>& folder() const { return folder_; }

  /// Whether a buffer is the binary chunk; else it has a URI.
  [[nodiscard]] bool is_binary_chunk(std::size_t buffer) const;
  /// The file of a buffer that is not in this one; none for the others.
  [[nodiscard]] std::optional<std::filesystem::path> file_of_buffer(std::size_t buffer) const;
  /// The bytes of a buffer. Errors: malformed, unsupported, cannot_open.
  Result<std::string_view> bytes_of_buffer(std::size_t index) { return buffer(index); }

private:
  struct Layout; // where the elements of an accessor lie
  struct Slice {
    std::string_view bytes; // from the first element to the end of the view
    std::size_t stride = 0;
  };

  Result<std::string_view> buffer(std::size_t index);
  Result<std::string> load_buffer(const Json& buffer, const std::string& where);
  [[nodiscard]] std::optional<std::filesystem::path> file_of_uri(const std::string& uri) const;
  Result<std::string> load_file(const std::string& uri, const std::string& where);
  Result<Slice> slice(const Json& view_index, std::size_t offset, const Layout& layout,
                      bool may_interleave, const std::string& where);
  bool shares_bytes(std::size_t accessor, const Place& place, std::size_t size) const;
  Result<Layout> layout_of(const Json& accessor, std::size_t components,
                           const std::string& where) const;
  Status apply_sparse(const Json& sparse, const Layout& layout, const std::string& where,
                      std::vector<double>& values);

  Source source_;
  std::optional<std::filesystem::path> folder_;
  Json json_;
  std::string_view json_text_;
  std::string_view binary_chunk_;
  std::vector<Chunk> chunks_;
  std::vector<std::optional<std::string>>
      loaded_; // buffers that are not the unchanged binary chunk
};

} // namespace cagewright
