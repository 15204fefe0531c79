/// \file
/// The header of a PLY file: what the elements after it hold.
#pragma once

#include "io/source.h"
#include <cagewright/core/result.h>

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace cagewright {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of a value.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type; ///< of a list: the type of its length
};

struct PlyElement {
  std::string_view name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of the property, or none.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
  enum class Encoding { text, little_endian, big_endian };
  Encoding encoding = Encoding::text;
  std::vector<PlyElement> elements;
  std::vector<std::string_view> comments; ///< and lines "obj_info"
  std::size_t end = 0;                    ///< offset of the first byte after the header

  /// Rows that take room in the file: those of elements with properties.
  [[nodiscard]] std::size_t rows() const;
};

/// Whether the first line is the word "ply" alone.
bool begins_ply(std::string_view bytes);

/// Parses the header. Errors: malformed, unsupported.
Result<PlyHeader> read_ply_header(const Source& source);

} // namespace cagewright
