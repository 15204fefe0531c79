#include <cagewright/io/read_vertex_weights.h>

#include "io/binary.h"
#include "io/read_file.h"
#include "io/source.h"
#include "io/text_cursor.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace cagewright {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr std::string_view remedy = "; write one number of 0 or more for each vertex of the model";

bool is_weight(double value) {
  return std::isfinite(value) && value >= 0;
}

Error wrong_count(const Source& source, std::size_t found, std::size_t count) {
  return source.error("has " + counted(found, "number") + ", but the model has " +
                          std::to_string(count) + " vertices" + std::string(remedy),
                      ErrorCode::mismatch);
}

Result<std::vector<double>> read_text(const Source& source, std::size_t count) {
  TextCursor cursor(source);
  std::vector<double> weights;
  std::size_t found = 0;
  for (; cursor.next_word_of_file(); cursor.next_line(), ++found) {
    const std::string word = in_quotes(cursor.peek_word());
    const std::optional<double> value = cursor.any_number();
    if (!value) {
      return cursor.error(word + " is not a number" + std::string(remedy));
    }
    if (!is_weight(*value)) {
      return cursor.error(word + " cannot be a weight" + std::string(remedy));
    }
    cursor.skip_blanks();
    if (!cursor.at_line_end()) {
      return cursor.error("has more than one number in a line" + std::string(remedy));
    }
    if (found < count) {
      weights.push_back(*value);
    }
  }
  if (found != count) {
    return wrong_count(source, found, count);
  }
  return weights;
}

/// What a .npy file says of its array.
struct Npy {
  char kind = 0; ///< f, i, u or b
  std::size_t item = 0;
  std::vector<std::size_t> shape;
  std::size_t data = 0; ///< where the numbers begin
};

/// What stands after `key` in the header.
std::optional<std::string_view> after(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == header.npos) {
    return std::nullopt;
  }
  const std::size_t begin = header.find_first_not_of(" :", at + key.size());
  return begin == header.npos ? std::string_view() : header.substr(begin);
}

std::vector<std::size_t> parse_shape(std::string_view text) {
  std::vector<std::size_t> shape;
  const char* const end = text.data() + std::min(text.find(')'), text.size());
  for (const char* at = text.data(); at < end;) {
    std::size_t extent = 0;
    const auto [to, error] = std::from_chars(at, end, extent);
    if (error == std::errc()) {
      shape.push_back(extent);
    }
    at = to == at ? at + 1 : to;
  }
  return shape;
}

std::optional<Npy> parse_npy(std::string_view bytes) {
  if (bytes.size() < 12) {
    return std::nullopt;
  }
  const bool is_first_version = bytes[6] == 1;
  const std::size_t begin = is_first_version ? 10 : 12;
  const std::size_t length = is_first_version
                                 ? load<std::uint16_t>(bytes.data() + 8, std::endian::little)
                                 : load<std::uint32_t>(bytes.data() + 8, std::endian::little);
  if (length > bytes.size() - begin) {
    return std::nullopt;
  }
  const std::string_view header = bytes.substr(begin, length);
  const auto type = after(header, "'descr'");
  const auto shape = after(header, "'shape'");
  if (!type || !shape || type->size() < 5 || shape->empty()) {
    return std::nullopt;
  }
  Npy npy;
  const char order = (*type)[1]; // after the quote
  npy.kind = (*type)[2];
  npy.item = static_cast<std::size_t>((*type)[3] - '0');
  npy.shape = parse_shape(shape->substr(1));
  npy.data = begin + length;
  const bool known = npy.kind == 'f'   ? npy.item == 4 || npy.item == 8
                     : npy.kind == 'b' ? npy.item == 1
                     : npy.kind == 'i' || npy.kind == 'u'
                         ? std::has_single_bit(npy.item) && npy.item <= 8
                         : false;
  const bool closed = (*type)[4] == '\'';
  if (!known || !closed || (order != '<' && !(order == '|' && npy.item == 1))) {
    return std::nullopt;
  }
  return npy;
}

double value_at(const char* from, const Npy& npy) {
  constexpr std::endian little = std::endian::little;
  if (npy.kind == 'f') {
    return npy.item == 4 ? load<float>(from, little) : load<double>(from, little);
  }
  const bool is_signed = npy.kind == 'i';
  switch (npy.item) {
  case 1:
    return is_signed ? load<std::int8_t>(from, little) : load<std::uint8_t>(from, little);
  case 2:
    return is_signed ? load<std::int16_t>(from, little) : load<std::uint16_t>(from, little);
  case 4:
    return is_signed ? load<std::int32_t>(from, little) : load<std::uint32_t>(from, little);
  default:
    return is_signed ? static_cast<double>(load<std::int64_t>(from, little))
                     : static_cast<double>(load<std::uint64_t>(from, little));
  }
}

Result<std::vector<double>> read_npy(const Source& source, std::size_t count) {
  const std::optional<Npy> npy = parse_npy(source.bytes);
  if (!npy) {
    return source.error("is no NumPy array of numbers that can be read here; save it by "
                        "numpy.save(file, weights.astype('<f8'))");
  }
  const bool is_column = npy->shape.size() == 1 || (npy->shape.size() == 2 && npy->shape[1] == 1);
  if (!is_column) {
    return source.error("the array must have one dimension" + std::string(remedy));
  }
  if (npy->shape[0] != count) {
    return wrong_count(source, npy->shape[0], count);
  }
  if ((source.bytes.size() - npy->data) / npy->item < count) {
    return source.error("the file ends before its last number; it is cut short");
  }
  std::vector<double> weights(count);
  for (std::size_t v = 0; v < count; ++v) {
    weights[v] = value_at(source.bytes.data() + npy->data + v * npy->item, *npy);
    if (!is_weight(weights[v])) {
      return source.error("number " + std::to_string(v) + " (from 0) is " +
                          std::to_string(weights[v]) + ", which cannot be a weight" +
                          std::string(remedy));
    }
  }
  return weights;
}

} // namespace

Result<std::vector<double>> read_vertex_weights(std::string_view bytes, std::string_view name,
                                                std::size_t count) {
  const Source source{name, bytes};
  return bytes.starts_with(npy_magic) ? read_npy(source, count) : read_text(source, count);
}

Result<std::vector<double>> read_vertex_weights(const std::filesystem::path& path,
                                                std::size_t count) {
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) {
    return bytes.error();
  }
  return read_vertex_weights(bytes->view(), one_line(path.string()), count);
}

} // namespace cagewright
