#include "io/ply_header.h"

#include "io/text_cursor.h"

#include <algorithm>
#include <string>

namespace cagewright {
namespace {

std::optional<PlyType> type_of(std::string_view name) {
  struct Known {
    std::string_view name;
    PlyType type;
  };
  // Both families of names are in use; the 64-bit integers are an extension of some programs.
  constexpr Known known[] = {
      {"char", PlyType::int8},        {"int8", PlyType::int8},      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},      {"short", PlyType::int16},    {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},    {"uint16", PlyType::uint16},  {"int", PlyType::int32},
      {"int32", PlyType::int32},      {"uint", PlyType::uint32},    {"uint32", PlyType::uint32},
      {"int64", PlyType::int64},      {"uint64", PlyType::uint64},  {"float", PlyType::float32},
      {"float32", PlyType::float32},  {"double", PlyType::float64}, {"float64", PlyType::float64},
      {"double64", PlyType::float64}, {"single", PlyType::float32}, {"real", PlyType::float32},
      {"ubyte", PlyType::uint8},      {"byte", PlyType::uint8}};
  std::string lower(name.substr(0, 16));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (lower.ends_with("_t")) {
    lower.resize(lower.size() - 2); // uint8_t
  }
  for (const Known& kind : known) {
    if (lower == kind.name) {
      return kind.type;
    }
  }
  return std::nullopt;
}

class HeaderReader {
public:
  // The header's lines end with \n, before which a \r is a blank, or with \r alone as its first
  // line does, whatever bytes follow the header.
  explicit HeaderReader(const Source& source)
      : source_(source), at_(source.bytes.find_first_of("\r\n")) {
    if (at_ != source.bytes.npos) {
      line_end_ =
          source.bytes[at_] == '\r' && source.bytes.substr(at_ + 1, 1) != "\n" ? '\r' : '\n';
      at_ = source.bytes.find(line_end_, at_) + 1;
    }
  }

  Result<PlyHeader> read() {
    if (!begins_ply(source_.bytes)) {
      return source_.error("does not begin with a line 'ply'; check that this is a PLY file");
    }
    while (true) {
      const std::size_t end = source_.bytes.find(line_end_, at_);
      if (end == source_.bytes.npos) {
        return source_.error_in_line(at_, "the header has no 'end_header'; the file is cut short" +
                                              std::string(export_again));
      }
      words_ = source_.bytes.substr(at_, end - at_);
      const std::string_view keyword = word();
      if (keyword == "end_header") {
        header_.end = end + 1;
        break;
      }
      if (const Status status = read_line(keyword); !status) {
        return status.error();
      }
      at_ = end + 1;
    }
    return has_format_
               ? Result<PlyHeader>(std::move(header_))
               : source_.error("the header has no line 'format'" + std::string(export_again));
  }

private:
  Status read_line(std::string_view keyword) {
    if (keyword == "format") {
      return read_format();
    }
    if (keyword == "element") {
      return read_element();
    }
    if (keyword == "property") {
      return read_property();
    }
    if (keyword == "comment" || keyword == "obj_info") {
      const std::size_t from = std::min(words_.find_first_not_of(" \t"), words_.size());
      header_.comments.push_back(words_.substr(from, words_.find_last_not_of(" \t\r") + 1 - from));
      return success();
    }
    if (keyword.empty()) {
      return success();
    }
    if (header_.elements.empty()) {
      return success(); // Blender 2.4 wrote a comment without the word; later it would be a danger
    }
    return wrong(in_quotes(keyword) + " is no PLY header statement");
  }

  Status read_format() {
    const std::string_view name = word();
    has_format_ = true;
    if (name == "ascii") {
      header_.encoding = PlyHeader::Encoding::text;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyHeader::Encoding::little_endian;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyHeader::Encoding::big_endian;
    } else {
      return wrong("the format " + in_quotes(name) + " is not one of PLY's");
    }
    return success();
  }

  Status read_element() {
    PlyElement element;
    element.name = word();
    const std::string_view count = word();
    const char* const end = count.data() + count.size();
    const auto [to, error] = std::from_chars(count.data(), end, element.count);
    if (error != std::errc() || to != end || count.empty()) {
      return wrong("an element needs a name and a count, but the count is " + in_quotes(count));
    }
    header_.elements.push_back(std::move(element));
    return success();
  }

  Status read_property() {
    if (header_.elements.empty()) {
      return wrong("a property stands before any element");
    }
    PlyProperty property;
    std::string_view type_name = word();
    if (type_name == "list") {
      const std::string_view count_name = word();
      property.count_type = type_of(count_name);
      if (!property.count_type) {
        return wrong("the type " + in_quotes(count_name) + " is not one of PLY's");
      }
      type_name = word();
    }
    const std::optional<PlyType> type = type_of(type_name);
    if (!type) {
      return wrong("the type " + in_quotes(type_name) + " is not one of PLY's");
    }
    property.type = *type;
    property.name = word();
    header_.elements.back().properties.push_back(property);
    return success();
  }

  std::string_view word() {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t from = std::min(words_.find_first_not_of(blanks), words_.size());
    const std::size_t to = std::min(words_.find_first_of(blanks, from), words_.size());
    const std::string_view found = words_.substr(from, to - from);
    words_.remove_prefix(to);
    return found;
  }

  [[nodiscard]] Error wrong(const std::string& what) const {
    return source_.error_in_line(at_, what + std::string(export_again));
  }

  Source source_;
  std::size_t at_;         // the start of the line
  std::string_view words_; // what is left of it
  char line_end_ = '\n';
  PlyHeader header_;
  bool has_format_ = false;
};

} // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
  case PlyType::int8:
  case PlyType::uint8:
    return 1;
  case PlyType::int16:
  case PlyType::uint16:
    return 2;
  case PlyType::int32:
  case PlyType::uint32:
  case PlyType::float32:
    return 4;
  case PlyType::int64:
  case PlyType::uint64:
  case PlyType::float64:
    return 8;
  }
  return 8;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) {
      return i;
    }
  }
  return std::nullopt;
}

std::size_t PlyHeader::rows() const {
  std::size_t sum = 0;
  for (const PlyElement& element : elements) {
    sum += element.properties.empty() ? 0 : element.count;
  }
  return sum;
}

bool begins_ply(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) {
    bytes.remove_prefix(3); // the mark that some editors put before UTF-8 text
  }
  const std::size_t end = bytes.find_first_not_of(" \t", 3);
  return bytes.starts_with("ply") && end != bytes.npos &&
         (bytes[end] == '\n' || bytes[end] == '\r');
}

Result<PlyHeader> read_ply_header(const Source& source) {
  return HeaderReader(source).read();
}

} // namespace cagewright
