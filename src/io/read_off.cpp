#include "io/binary.h"
#include "io/off_header.h"
#include "io/off_text.h"
#include "io/readers.h"
#include "io/repeated_corners.h"
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
  OffReader(const Source& source, const TextCursor& cursor, OffHeader header, Reading& reading)
      : reading_(reading), attributes_(reading.attributes), source_(source), cursor_(cursor),
        header_(header) {}

  Result<PolygonMesh> read() {
    if (const Status status = read_counts(); !status) {
      return status.error();
    }
    layout_ = off_layout(cursor_, header_, counts_.vertices);
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
    if (attributes_ != nullptr) {
      finish_attributes();
    }
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
      skip_off_edges(cursor_);
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

  // One vertex to a line.
  Status read_vertex(std::size_t v) {
    std::array<double, 16> values{};
    const std::size_t needed = header_.has_weight ? 4 : 3;
    std::size_t count = 0;
    if (!cursor_.next_word_of_file()) {
      return ends_early(v, "vertex", counts_.vertices);
    }
    for (; !cursor_.at_line_end() && count < values.size(); cursor_.skip_blanks()) {
      const std::optional<double> value = count < needed ? cursor_.number() : cursor_.any_number();
      if (!value && count < needed) {
        return cursor_.error(not_a_number(cursor_.peek_word()));
      }
      if (!value) {
        break;
      }
      values[count++] = *value;
    }
    if (count < needed) {
      return cursor_.error("vertex " + std::to_string(v) + " needs " + std::to_string(needed) +
                           " coordinates, but has " + std::to_string(count) +
                           std::string(export_again));
    }
    Vec3 position(values[0], values[1], values[2]);
    if (header_.has_weight) {
      position /= values[3];
      if (!position.allFinite()) {
        return cursor_.error("vertex " + std::to_string(v) +
                             " lies at infinity: its fourth coordinate is " +
                             std::to_string(values[3]) + std::string(export_again));
      }
    }
    mesh_.positions.push_back(position);
    keep_dress(values, count, needed);
    cursor_.next_line();
    return success();
  }

  void keep_dress(const std::array<double, 16>& values, std::size_t count, std::size_t needed) {
    if (header_.has_color) {
      const std::size_t end = std::min(count, layout_.color_end);
      mesh_.colors.push_back(
          end < layout_.color + 3 ? white : color_at(&values[layout_.color], end - layout_.color));
    }
    const bool is_plain = !header_.has_color && !header_.has_normal && !header_.has_texture;
    if (is_plain && count > needed) {
      reading_.notes.add(
          "extra_numbers", [&] { return cursor_.place(); },
          "more numbers behind a vertex than the header tells of; they are left out (a header "
          "COFF says that they are colours)");
    }
    if (attributes_ == nullptr) {
      return;
    }
    if (header_.has_normal) {
      attributes_->normals.emplace_back(Vec3::Zero());
      if (count >= layout_.normal + 3) {
        attributes_->normals.back() =
            Vec3(values[layout_.normal], values[layout_.normal + 1], values[layout_.normal + 2]);
      }
    }
    if (layout_.texture != 0) {
      attributes_->texture_points.push_back({values[layout_.texture], values[layout_.texture + 1]});
    }
  }

  void finish_attributes() {
    MeshAttributes& all = *attributes_;
    if (header_.has_normal) {
      all.normal_of_corner.assign(mesh_.corners().begin(), mesh_.corners().end());
      for (Index& corner : all.normal_of_corner) {
        corner = all.normals[corner].allFinite() ? corner : MeshAttributes::none;
      }
    }
    if (layout_.texture != 0) {
      all.texture_of_corner.assign(mesh_.corners().begin(), mesh_.corners().end());
    }
    scale_face_colors();
  }

  // Like those of vertices: bytes if any channel is above 1.
  void scale_face_colors() {
    if (!has_face_color_) {
      attributes_->face_colors.clear();
      return;
    }
    PolygonMesh scaled;
    scaled.colors = std::move(attributes_->face_colors);
    normalize_colors(scaled);
    attributes_->face_colors = std::move(scaled.colors);
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
    keep_face(begin);
    cursor_.next_line();
    return success();
  }

  void keep_face(std::size_t begin) {
    const auto place = [&] { return source_.place_in_line(begin); };
    if (!is_surface(corners_.size())) {
      reading_.notes.add("short_face", place,
                         "a face of " + counted(corners_.size(), "corner") +
                             " is no surface and is left out");
      return;
    }
    if (drop_repeated_corners(corners_, [](Index vertex) { return vertex; })) {
      reading_.notes.add("repeated_corner", place, repeated_corner_note);
    }
    mesh_.add_face(corners_);
    if (attributes_ != nullptr) {
      keep_face_color();
    }
  }

  // Behind the corners: nothing, a number of a colour map, or three or four channels.
  void keep_face_color() {
    std::array<double, 4> values{};
    std::size_t count = 0;
    for (cursor_.skip_blanks(); count < 4 && !cursor_.at_line_end(); cursor_.skip_blanks()) {
      const std::optional<double> value = cursor_.any_number();
      if (!value) {
        break;
      }
      values[count++] = *value;
    }
    attributes_->face_colors.push_back(count < 3 ? white : color_at(values.data(), count));
    has_face_color_ |= count >= 3;
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

  Reading& reading_;
  MeshAttributes* attributes_; // or null
  Source source_;
  TextCursor cursor_;
  OffHeader header_;
  OffLayout layout_;
  Counts counts_;
  PolygonMesh mesh_;
  std::vector<Index> corners_;
  bool has_face_color_ = false;
};

// The same numbers as big-endian floats and 32-bit integers; each face ends with a count of colour
// channels and those.
class OffBinaryReader {
public:
  OffBinaryReader(const Source& source, std::size_t begin, OffHeader header, Reading& reading)
      : reading_(reading), source_(source), at_(begin), header_(header) {}

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
    if (reading_.attributes != nullptr && (header_.has_normal || header_.has_texture)) {
      reading_.attributes->others.emplace_back("normals and texture points of binary OFF");
    }
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
    const auto place = [&] { return source_.place_at_byte(begin); };
    if (!is_surface(corners_.size())) {
      reading_.notes.add("short_face", place,
                         "a face of " + counted(corners_.size(), "corner") +
                             " is no surface and is left out");
      return success();
    }
    if (drop_repeated_corners(corners_, [](Index vertex) { return vertex; })) {
      reading_.notes.add("repeated_corner", place, repeated_corner_note);
    }
    mesh_.add_face(corners_);
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

  Reading& reading_;
  Source source_;
  std::size_t at_;
  OffHeader header_;
  PolygonMesh mesh_;
  std::vector<Index> corners_;
};

} // namespace

Result<PolygonMesh> read_off(const Source& source, Reading& reading) {
  TextCursor cursor(source);
  const OffHeader header = take_off_header(cursor).value_or(OffHeader{}); // the word is optional
  cursor.skip_blanks();
  if (header.has_size) {
    cursor.next_word_of_file();
    const std::size_t at = cursor.offset();
    const std::optional<std::int64_t> dimension = cursor.integer();
    if (dimension != 3 || header.has_weight) {
      return source.error_in_line(at, "points of " +
                                          (dimension ? std::to_string(*dimension) : "unknown") +
                                          (header.has_weight ? " homogeneous" : "") +
                                          " dimensions (nOFF) are not supported; export the model "
                                          "in 3 dimensions");
    }
  }
  if (cursor.peek_word() == "BINARY") {
    if (header.has_weight) {
      return cursor.error("binary OFF with homogeneous coordinates (4OFF) is not supported; export "
                          "it as text or PLY");
    }
    cursor.next_line();
    return OffBinaryReader(source, cursor.offset(), header, reading).read();
  }
  return OffReader(source, cursor, header, reading).read();
}

} // namespace cagewright
