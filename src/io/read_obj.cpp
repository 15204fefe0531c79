// Our own reader, because the packaged one (tinyobjloader) does not round doubles correctly and
// cannot tell which line is wrong.
#include "io/readers.h"
#include "io/text_cursor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

namespace cagewright {
namespace {

class ObjReader {
public:
  /// With `normals` given, fills it as well.
  explicit ObjReader(const Source& source, FileNormals* normals = nullptr)
      : normals_(normals), source_(source), cursor_(source, TextCursor::Backslash::continues) {}

  Result<PolygonMesh> read() {
    for (; cursor_.next_word_of_file(); cursor_.next_line()) {
      if (const Status status = read_statement(); !status) {
        return status.error();
      }
    }
    if (mesh_.face_count() == 0) {
      return unknown_ ? source_.error_in_line(*unknown_, not_obj(*unknown_)) : no_faces(source_);
    }
    if (!mesh_.colors.empty()) {
      mesh_.colors.resize(mesh_.positions.size(), white);
      normalize_colors(mesh_);
    }
    if (normals_ != nullptr) {
      finish_normals();
    }
    return std::move(mesh_);
  }

private:
  Status read_statement() {
    const std::size_t begin = cursor_.offset();
    const std::string_view keyword = cursor_.word();
    if (keyword == "v") {
      return read_vertex();
    }
    if (keyword == "f" || keyword == "fo") { // fo: the name in the first version of the format
      return read_face(begin);
    }
    if (keyword == "vn" && normals_ != nullptr) {
      return read_normal();
    }
    if (keyword == "o" || keyword == "g") {
      const std::string_view name = cursor_.rest_of_line();
      group_ = name.empty() ? "default" : name;
      group_index_.reset();
    } else if (!is_known(keyword)) {
      if (keyword.find('\0') != keyword.npos) {
        return source_.error_in_line(begin, not_obj(begin));
      }
      unknown_ = unknown_.value_or(begin); // extensions exist: wait whether faces come
    }
    return success();
  }

  static bool is_known(std::string_view keyword) {
    constexpr auto known =
        std::to_array<std::string_view>({"vt", "vn", "vp", "l", "p", "s", "usemtl", "mtllib"});
    return std::find(known.begin(), known.end(), keyword) != known.end();
  }

  [[nodiscard]] std::string not_obj(std::size_t offset) const {
    TextCursor at = cursor_;
    at.move_to(offset);
    return in_quotes(at.peek_word()) +
           " is no OBJ statement, and the file has no faces; check that "
           "this is an OBJ file";
  }

  // v x y z, then nothing, a weight (ignored), or a colour: r g b or r g b a.
  Status read_vertex() {
    std::array<double, 7> values{};
    std::size_t count = 0;
    for (cursor_.skip_blanks(); !cursor_.at_line_end() && count < 7; cursor_.skip_blanks()) {
      const std::optional<double> value = count < 3 ? cursor_.number() : cursor_.any_number();
      if (!value) {
        return cursor_.error(in_quotes(cursor_.peek_word()) + " is not a finite number" +
                             std::string(export_again));
      }
      values[count++] = *value;
    }
    if (count < 3) {
      return cursor_.error("a vertex needs 3 coordinates, but this has " + std::to_string(count) +
                           std::string(export_again));
    }
    mesh_.positions.emplace_back(values[0], values[1], values[2]);
    if (count >= 6) {
      mesh_.colors.resize(mesh_.positions.size() - 1, white);
      mesh_.colors.push_back({static_cast<float>(values[3]), static_cast<float>(values[4]),
                              static_cast<float>(values[5]),
                              count == 7 ? static_cast<float>(values[6]) : full_channel});
    }
    return success();
  }

  Status read_normal() {
    Vec3& normal = normals_->normals.emplace_back();
    for (double& component : normal) {
      cursor_.skip_blanks();
      const std::optional<double> value = cursor_.any_number();
      if (!value) {
        return cursor_.error("a normal needs 3 numbers" + std::string(export_again));
      }
      component = *value;
    }
    return success();
  }

  // Faces may stand before their normals, so that only the end shows which there are. Until then
  // of_corner counts the lines of normals; from here on a line and a vertex make a normal.
  void finish_normals() {
    const std::vector<Vec3> lines = std::exchange(normals_->normals, {});
    std::unordered_map<std::uint64_t, Index> seen;
    for (std::size_t c = 0; c < normals_->of_corner.size(); ++c) {
      Index& corner = normals_->of_corner[c];
      if (corner >= lines.size()) {
        corner = FileNormals::none;
        continue;
      }
      const std::uint64_t pair = (std::uint64_t{corner} << 32U) | mesh_.corners()[c];
      const auto [entry, is_new] =
          seen.try_emplace(pair, static_cast<Index>(normals_->normals.size()));
      if (is_new) {
        normals_->normals.push_back(lines[corner]);
        normals_->in_file.push_back(corner);
      }
      corner = entry->second;
    }
    if (normals_->normals.empty()) {
      normals_->of_corner.clear();
    }
  }

  Status read_face(std::size_t begin) {
    corners_.clear();
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      const std::size_t word = cursor_.offset();
      const std::optional<std::int64_t> vertex = cursor_.integer_prefix();
      if (!vertex || !skip_texture_and_normal()) {
        return corner_error(word, vertex.has_value());
      }
      const std::int64_t count = static_cast<std::int64_t>(mesh_.positions.size());
      const std::int64_t index = *vertex > 0 ? *vertex - 1 : *vertex + count;
      // Faces may stand before their vertices, which are counted then, once.
      if (*vertex == 0 || index < 0 || (index >= count && index >= vertices_in_file())) {
        return vertex_error(begin, *vertex);
      }
      corners_.push_back(static_cast<Index>(index));
    }
    if (corners_.size() < 3) {
      return source_.error_in_line(begin, "a face needs 3 corners, but this has " +
                                              std::to_string(corners_.size()) +
                                              std::string(export_again));
    }
    mesh_.add_face(corners_);
    add_to_group();
    return success();
  }

  // The "/vt", "//vn" or "/vt/vn" after a corner's vertex.
  bool skip_texture_and_normal() {
    std::optional<std::int64_t> normal;
    for (int i = 0; i < 2 && cursor_.skip('/'); ++i) {
      const std::optional<std::int64_t> index = cursor_.integer_prefix();
      normal = i == 1 ? index : std::nullopt;
    }
    if (normals_ != nullptr) {
      normals_->of_corner.push_back(normal_index(normal));
    }
    return cursor_.at_number_end();
  }

  [[nodiscard]] Index normal_index(const std::optional<std::int64_t>& normal) const {
    if (!normal || *normal == 0) {
      return FileNormals::none;
    }
    const auto count = static_cast<std::int64_t>(normals_->normals.size());
    const std::int64_t index = *normal > 0 ? *normal - 1 : *normal + count;
    return index >= 0 && index < FileNormals::none ? static_cast<Index>(index) : FileNormals::none;
  }

  Error corner_error(std::size_t word, bool has_vertex) {
    cursor_.move_to(word);
    const std::string_view text = cursor_.peek_word();
    const std::string_view digits = text.substr(0, text.find('/'));
    if (!has_vertex && !digits.empty() &&
        digits.find_first_not_of("0123456789", digits[0] == '-' ? 1 : 0) ==
            std::string_view::npos) {
      return source_.error_in_line(word,
                                   no_such_vertex("face", one_line(digits, 40),
                                                  static_cast<std::size_t>(vertices_in_file())));
    }
    return source_.error_in_line(word, in_quotes(text) + " is not a corner of a face" +
                                           std::string(export_again));
  }

  Error vertex_error(std::size_t begin, std::int64_t vertex) {
    if (vertex == 0) {
      return source_.error_in_line(begin, "face refers to vertex 0, but OBJ counts from 1" +
                                              std::string(export_again));
    }
    if (vertex < 0) {
      return source_.error_in_line(begin, "face refers to vertex " + std::to_string(vertex) +
                                              ", but only " +
                                              std::to_string(mesh_.positions.size()) +
                                              " stand before it" + std::string(export_again));
    }
    return source_.error_in_line(begin,
                                 no_such_vertex("face", std::to_string(vertex),
                                                static_cast<std::size_t>(vertices_in_file())));
  }

  std::int64_t vertices_in_file() {
    if (!vertices_in_file_) {
      TextCursor ahead(source_, TextCursor::Backslash::continues);
      vertices_in_file_ = 0;
      for (; ahead.next_word_of_file(); ahead.next_line()) {
        *vertices_in_file_ += ahead.peek_word() == "v" ? 1 : 0;
      }
    }
    return *vertices_in_file_;
  }

  // Groups are counted when a face comes, so that none is empty. Faces before the first name are
  // in a group of their own if there is any other.
  void add_to_group() {
    if (group_.empty()) {
      return;
    }
    if (!group_index_) {
      if (mesh_.face_groups.empty() && mesh_.face_count() > 1) {
        group_indices_.emplace("default", 0);
        mesh_.group_names.emplace_back("default");
        mesh_.face_groups.assign(mesh_.face_count() - 1, 0);
      }
      const auto [entry, is_new] =
          group_indices_.emplace(std::string(group_), static_cast<Index>(mesh_.group_names.size()));
      if (is_new) {
        mesh_.group_names.push_back(entry->first);
      }
      group_index_ = entry->second;
    }
    mesh_.face_groups.push_back(*group_index_);
  }

  FileNormals* normals_; // or null
  Source source_;
  TextCursor cursor_;
  PolygonMesh mesh_;
  std::vector<Index> corners_;
  std::optional<std::size_t> unknown_; // where the first unknown statement stands
  std::optional<std::int64_t> vertices_in_file_;
  std::string_view group_;
  std::optional<Index> group_index_;
  std::unordered_map<std::string, Index> group_indices_;
};

} // namespace

Result<PolygonMesh> read_obj(const Source& source, Reading& reading) {
  return ObjReader(source, reading.normals).read();
}

} // namespace cagewright
