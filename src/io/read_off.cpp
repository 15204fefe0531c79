#include "io/binary.h"
#include "io/off_header.h"
#include "io/readers.h"
#include "io/text_cursor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace cagewright {
namespace {

struct Counts {
  std::size_t vertices = 0;
  std::size_t faces = 0;
};

// Faces of one or two corners are points and lines to OFF, and no part of a surface.
bool is_surface(std::size_t corners) {
  return corners >= 3;
}

class OffReader {
public:
  OffReader(const Source& source, const TextCursor& cursor, OffHeader header)
      : source_(source), cursor_(cursor), header_(header) {}

  Result<PolygonMesh> read() {
    if (const Status status = read_counts(); !status) {
      return status.error();
    }
    mesh_.positions.reserve(counts_.vertices);
    for (std::size_t v = 0; v < counts_.vertices; ++v) {
      if (const Status status = read_vertex(v); !status) {
        return status.error();
      }
    }
    for (std::size_t f = 0; f < counts_.faces; ++f) {
      if (const Status status = read_face(f); !status) {
        return status.error();
      }
    }
    if (mesh_.face_count() == 0) {
      return no_faces(source_);
    }
    normalize_colors(mesh_);
    return std::move(mesh_);
  }

private:
  Status read_counts() {
    const Result<std::size_t> vertices = read_count("vertices", true);
    if (!vertices) {
      return vertices.error();
    }
    const Result<std::size_t> faces = read_count("faces", true);
    if (!faces) {
      return faces.error();
    }
    const Result<std::size_t> edges = read_count("edges", false);
    if (!edges) {
      return edges.error();
    }
    counts_ = {*vertices, *faces};
    if (counts_.vertices > std::numeric_limits<Index>::max()) {
      return too_many_vertices(source_, counts_.vertices);
    }
    // A vertex takes at least six bytes ("0 0 0" and the line end), a face two.
    const std::size_t room = cursor_.remaining() + 1;
    if (counts_.vertices > room / 6 || counts_.faces > (room - counts_.vertices * 6) / 2) {
      return cursor_.error("the header promises " + counted(*vertices, "vertex") + " and " +
                           counted(*faces, "face") + ", but the file ends before; it is cut short" +
                           std::string(export_again));
    }
    return success();
  }

  // The count of edges is never needed, and some files leave it out.
  Result<std::size_t> read_count(const char* what, bool required) {
    if (required) {
      cursor_.next_word_of_file();
    } else {
      cursor_.skip_blanks();
      if (cursor_.at_line_end()) {
        return std::size_t{0};
      }
    }
    const std::size_t begin = cursor_.offset();
    const std::optional<std::int64_t> count = cursor_.integer();
    if (!count || (*count < 0 && required)) {
      cursor_.move_to(begin);
      return cursor_.error("the header should have the number of " + std::string(what) +
                           " here, but has " + found_here() + std::string(export_again));
    }
    return static_cast<std::size_t>(*count);
  }

  // One vertex to a line; what its line has more than the header says is ignored.
  Status read_vertex(std::size_t v) {
    std::array<double, 10> values{};
    const std::size_t color = header_.has_normal ? 6 : 3;
    const std::size_t wanted = header_.has_color ? color + 4 : 3;
    std::size_t count = 0;
    if (!cursor_.next_word_of_file()) {
      return ends_early(v, "vertex", counts_.vertices);
    }
    for (; !cursor_.at_line_end() && count < wanted; cursor_.skip_blanks()) {
      const std::optional<double> value = count < 3 ? cursor_.number() : cursor_.any_number();
      if (!value) {
        return cursor_.error(found_here() + " is not a finite number" + std::string(export_again));
      }
      values[count++] = *value;
    }
    if (count < 3) {
      return cursor_.error("vertex " + std::to_string(v) + " needs 3 coordinates, but has " +
                           std::to_string(count) + std::string(export_again));
    }
    mesh_.positions.emplace_back(values[0], values[1], values[2]);
    if (header_.has_color) {
      mesh_.colors.push_back(count < color + 3 ? white : color_at(&values[color], count - color));
    }
    cursor_.next_line();
    return success();
  }

  static std::array<float, 4> color_at(const double* values, std::size_t count) {
    return {static_cast<float>(values[0]), static_cast<float>(values[1]),
            static_cast<float>(values[2]),
            count >= 4 ? static_cast<float>(values[3]) : full_channel};
  }

  // A face ends with its line: after the corners comes a colour, which is ignored.
  Status read_face(std::size_t f) {
    if (!cursor_.next_word_of_file()) {
      return ends_early(f, "face", counts_.faces);
    }
    const std::size_t begin = cursor_.offset();
    const std::optional<std::int64_t> count = cursor_.integer();
    if (!count || *count < 1) {
      cursor_.move_to(begin);
      return cursor_.error("face " + std::to_string(f) +
                           " should begin with its number of corners, but there is " +
                           found_here() + std::string(export_again));
    }
    corners_.clear();
    for (std::int64_t i = 0; i < *count; ++i) {
      if (const Status status = read_corner(f, *count); !status) {
        return status;
      }
    }
    if (is_surface(corners_.size())) {
      mesh_.add_face(corners_);
    }
    cursor_.next_line();
    return success();
  }

  Status read_corner(std::size_t f, std::int64_t count) {
    // Long faces may run over several lines.
    const std::size_t line_of_last = cursor_.offset();
    if (!cursor_.next_word_of_file()) {
      return source_.error_in_line(line_of_last, "face " + std::to_string(f) + " needs " +
                                                     std::to_string(count) + " corners, but has " +
                                                     std::to_string(corners_.size()) +
                                                     std::string(export_again));
    }
    const std::optional<std::int64_t> vertex = cursor_.integer();
    if (!vertex && !is_integer(cursor_.peek_word())) {
      return cursor_.error(found_here() + " is not a vertex number" + std::string(export_again));
    }
    if (!vertex || *vertex < 0 || static_cast<std::size_t>(*vertex) >= counts_.vertices) {
      return cursor_.error(no_such_vertex(
          "face " + std::to_string(f), one_line(cursor_word_before(vertex), 40), counts_.vertices));
    }
    corners_.push_back(static_cast<Index>(*vertex));
    return success();
  }

  // Many digits are an integer, even if too large for one.
  static bool is_integer(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == word.npos;
  }

  std::string cursor_word_before(const std::optional<std::int64_t>& vertex) {
    return vertex ? std::to_string(*vertex) : std::string(cursor_.peek_word());
  }

  std::string found_here() {
    return cursor_.at_line_end() ? "nothing" : in_quotes(cursor_.peek_word());
  }

  Error ends_early(std::size_t have, std::string_view noun, std::size_t want) {
    return cursor_.error("the file ends after " + std::to_string(have) + " of " +
                         counted(want, noun) + "; it is cut short" + std::string(export_again));
  }

  Source source_;
  TextCursor cursor_;
  OffHeader header_;
  Counts counts_;
  PolygonMesh mesh_;
  std::vector<Index> corners_;
};

// The same numbers as big-endian floats and 32-bit integers; each face ends with a count of colour
// channels and those.
class OffBinaryReader {
public:
  OffBinaryReader(const Source& source, std::size_t begin, OffHeader header)
      : source_(source), at_(begin), header_(header) {}

  Result<PolygonMesh> read() {
    const std::size_t begin = at_;
    const std::optional<std::uint32_t> vertices = integer();
    const std::optional<std::uint32_t> faces = integer();
    const std::optional<std::uint32_t> edges = integer();
    const std::size_t vertex_size = off_vertex_size(header_);
    if (!edges || remaining() < *vertices * vertex_size ||
        remaining() - *vertices * vertex_size < std::size_t{8} * *faces) {
      return source_.error_at_byte(begin, "the file ends before the vertices and faces that the "
                                          "header promises; it is cut short" +
                                              std::string(export_again));
    }
    mesh_.positions.reserve(*vertices);
    for (std::size_t v = 0; v < *vertices; ++v, at_ += vertex_size) {
      if (const Status status = read_vertex(v); !status) {
        return status.error();
      }
    }
    for (std::size_t f = 0; f < *faces; ++f) {
      if (const Status status = read_face(f); !status) {
        return status.error();
      }
    }
    if (mesh_.face_count() == 0) {
      return no_faces(source_);
    }
    normalize_colors(mesh_);
    return std::move(mesh_);
  }

private:
  Status read_vertex(std::size_t v) {
    const char* from = source_.bytes.data() + at_;
    const auto value = [&](std::size_t i) { return load<float>(from + 4 * i, std::endian::big); };
    const Vec3 p(value(0), value(1), value(2));
    if (!p.allFinite()) {
      return source_.error_at_byte(at_, "vertex " + std::to_string(v) +
                                            " has a coordinate that is not a finite number" +
                                            std::string(export_again));
    }
    mesh_.positions.push_back(p);
    if (header_.has_color) {
      const std::size_t color = header_.has_normal ? 6 : 3;
      mesh_.colors.push_back({value(color), value(color + 1), value(color + 2), value(color + 3)});
    }
    return success();
  }

  Status read_face(std::size_t f) {
    const std::size_t begin = at_;
    const std::uint32_t count = integer().value_or(0);
    if (count == 0 || count > remaining() / 4) {
      return cut_short(begin, f);
    }
    corners_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t vertex = *integer();
      if (vertex >= mesh_.positions.size()) {
        return source_.error_at_byte(begin, no_such_vertex("face " + std::to_string(f),
                                                           std::to_string(vertex),
                                                           mesh_.positions.size()));
      }
      corners_.push_back(vertex);
    }
    const std::optional<std::uint32_t> channels = integer();
    if (!channels || *channels > remaining() / 4) {
      return cut_short(begin, f);
    }
    at_ += std::size_t{4} * *channels;
    if (is_surface(corners_.size())) {
      mesh_.add_face(corners_);
    }
    return success();
  }

  [[nodiscard]] Error cut_short(std::size_t begin, std::size_t f) const {
    return source_.error_at_byte(begin, "face " + std::to_string(f) +
                                            " has no corners or more than the file holds; it is "
                                            "damaged" +
                                            std::string(export_again));
  }

  [[nodiscard]] std::size_t remaining() const { return source_.bytes.size() - at_; }

  std::optional<std::uint32_t> integer() {
    if (remaining() < 4) {
      return std::nullopt;
    }
    at_ += 4;
    return load<std::uint32_t>(source_.bytes.data() + at_ - 4, std::endian::big);
  }

  Source source_;
  std::size_t at_;
  OffHeader header_;
  PolygonMesh mesh_;
  std::vector<Index> corners_;
};

} // namespace

Result<PolygonMesh> read_off(const Source& source, Reading& reading) {
  static_cast<void>(reading);
  TextCursor cursor(source);
  cursor.next_word_of_file();
  const std::optional<OffHeader> header = off_header(cursor.peek_word());
  if (header) {
    cursor.word();
    if (header->has_weight || header->has_size) {
      return cursor.error("points of other than 3 coordinates are not supported; export the model "
                          "in 3 dimensions");
    }
  }
  cursor.skip_blanks();
  if (header && cursor.peek_word() == "BINARY") {
    cursor.next_line();
    return OffBinaryReader(source, cursor.offset(), *header).read();
  }
  return OffReader(source, cursor, header.value_or(OffHeader{})).read(); // the word is optional
}

} // namespace cagewright
