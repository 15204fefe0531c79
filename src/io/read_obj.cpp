// Our own reader, because the packaged one (tinyobjloader) does not round doubles correctly and
// cannot tell which line is wrong.
#include "io/obj_words.h"
#include "io/readers.h"
#include "io/repeated_corners.h"
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
  ObjReader(const Source& source, Reading& reading)
      : reading_(reading), normals_(reading.normals), attributes_(reading.attributes),
        source_(source), cursor_(source) {}

  Result<PolygonMesh> read() {
    for (; cursor_.next_word_of_file(); end_statement()) {
      if (const Status status = read_statement(); !status) {
        return status.error();
      }
    }
    if (mesh_.face_count() == 0) {
      return nothing_to_see();
    }
    if (!mesh_.colors.empty()) {
      mesh_.colors.resize(mesh_.positions.size(), white);
      normalize_colors(mesh_);
    }
    if (normals_ != nullptr) {
      finish_normals();
    }
    if (attributes_ != nullptr) {
      finish_attributes();
    }
    return std::move(mesh_);
  }

private:
  struct Corner {
    Index vertex;
    Index texture; // or none
    Index normal;  // or none
  };
  static constexpr Index none = MeshAttributes::none;

  Status read_statement() {
    const std::size_t begin = cursor_.offset();
    const std::string_view keyword = begin_obj_statement(cursor_);
    if (keyword == "v") {
      return read_vertex();
    }
    if (is_obj_face(keyword)) {
      return read_face(begin);
    }
    if (keyword == "vn") {
      read_normal();
    } else if (keyword == "vt") {
      read_texture_point();
    } else if (keyword == "o" || keyword == "g") {
      begin_group(keyword == "o", cursor_.rest_of_line());
    } else if (keyword == "usemtl" || keyword == "mtllib" || is_obj_list(keyword) ||
               keyword == "s") {
      has_surfaces_ = has_surfaces_ || keyword == "surf";
      if (attributes_ != nullptr) {
        read_attribute(keyword);
      }
    } else {
      if (keyword.find('\0') != keyword.npos) {
        return source_.error_in_line(begin, in_quotes(keyword) +
                                                " is no OBJ statement: there are "
                                                "zeros in the text, as damaged files have them" +
                                                std::string(export_again));
      }
      unknown_ = unknown_.value_or(begin); // extensions exist: wait whether faces come
      if (!keyword.empty() && !is_obj_setting(keyword)) {
        reading_.notes.add(
            "unknown_statement", [&] { return source_.place_in_line(begin); },
            in_quotes(keyword) + " is no OBJ statement; its line is left out");
      }
    }
    return success();
  }

  void end_statement() {
    cursor_.next_line();
    cursor_.set_backslash(TextCursor::Backslash::is_text);
  }

  [[nodiscard]] Error nothing_to_see() const {
    if (has_surfaces_) {
      return source_.error("has no faces, only free-form surfaces; export them as a mesh "
                           "(polygons)");
    }
    return unknown_ ? source_.error_in_line(*unknown_, not_obj(*unknown_)) : no_faces(source_);
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
        return cursor_.error(not_a_number(cursor_.peek_word()));
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

  // A normal that is none (1.#QNAN, or too few numbers) is kept as such: mostly nobody uses it.
  void read_normal() {
    ++normal_count_;
    if (normals_ == nullptr && attributes_ == nullptr) {
      return;
    }
    Vec3& normal = normal_lines_.emplace_back();
    for (double& component : normal) {
      cursor_.skip_blanks();
      component = cursor_.any_number().value_or(std::numeric_limits<double>::quiet_NaN());
    }
  }

  void read_texture_point() {
    ++texture_count_;
    if (attributes_ != nullptr) {
      std::array<double, 2>& point = attributes_->texture_points.emplace_back();
      for (double& component : point) {
        cursor_.skip_blanks();
        component = cursor_.at_line_end() ? 0.0 : cursor_.any_number().value_or(0.0);
      }
    }
  }

  void read_attribute(std::string_view keyword) {
    if (keyword == "usemtl") {
      material_ = index_of(material_indices_, attributes_->material_names, cursor_.rest_of_line());
    } else if (keyword == "mtllib") {
      const std::string name(cursor_.rest_of_line());
      if (std::find(attributes_->material_files.begin(), attributes_->material_files.end(), name) ==
          attributes_->material_files.end()) {
        attributes_->material_files.push_back(name);
      }
    } else if (keyword == "s") {
      const std::string_view group = cursor_.rest_of_line();
      if (group != "off" && group != "0" && !group.empty()) {
        add_other("smoothing groups");
      }
    } else {
      add_other(keyword == "l" ? "lines" : keyword == "p" ? "points" : "curves and surfaces");
    }
  }

  void add_other(std::string_view what) {
    if (std::find(attributes_->others.begin(), attributes_->others.end(), what) ==
        attributes_->others.end()) {
      attributes_->others.emplace_back(what);
    }
  }

  static Index index_of(std::unordered_map<std::string, Index>& indices,
                        std::vector<std::string>& names, std::string_view name) {
    const auto [entry, is_new] =
        indices.emplace(std::string(name), static_cast<Index>(names.size()));
    if (is_new) {
      names.push_back(entry->first);
    }
    return entry->second;
  }

  // Faces may stand before their normals, so that only the end shows which there are. Until then
  // of_corner counts the lines of normals; from here on a line and a vertex make a normal.
  void finish_normals() {
    std::unordered_map<std::uint64_t, Index> seen;
    for (std::size_t c = 0; c < normal_of_corner_.size(); ++c) {
      Index corner = normal_of_corner_[c];
      if (corner < normal_lines_.size()) {
        const std::uint64_t pair = (std::uint64_t{corner} << 32U) | mesh_.corners()[c];
        const auto [entry, is_new] =
            seen.try_emplace(pair, static_cast<Index>(normals_->normals.size()));
        if (is_new) {
          normals_->normals.push_back(normal_lines_[corner]);
          normals_->in_file.push_back(corner);
        }
        corner = entry->second;
      } else {
        corner = FileNormals::none;
      }
      normals_->of_corner.push_back(corner);
    }
    if (normals_->normals.empty()) {
      normals_->of_corner.clear();
    }
  }

  void finish_attributes() {
    MeshAttributes& all = *attributes_;
    all.normals = std::move(normal_lines_);
    all.normal_of_corner = std::move(normal_of_corner_);
    for (Index& corner : all.normal_of_corner) {
      // Normals that are none help nobody in another format.
      corner = corner < all.normals.size() && all.normals[corner].allFinite() ? corner : none;
    }
    for (Index& corner : all.texture_of_corner) {
      corner = corner < all.texture_points.size() ? corner : none;
    }
    const auto is_none = [](Index i) { return i == none; };
    if (std::all_of(all.normal_of_corner.begin(), all.normal_of_corner.end(), is_none)) {
      all.normals.clear();
      all.normal_of_corner.clear();
    }
    if (std::all_of(all.texture_of_corner.begin(), all.texture_of_corner.end(), is_none)) {
      all.texture_points.clear();
      all.texture_of_corner.clear();
    }
    if (std::all_of(all.face_materials.begin(), all.face_materials.end(), is_none)) {
      all.face_materials.clear();
      all.material_names.clear();
    }
  }

  Status read_face(std::size_t begin) {
    corners_.clear();
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      const std::size_t word = cursor_.offset();
      const std::optional<ObjCorner> corner = read_obj_corner(cursor_);
      if (!corner || !cursor_.at_number_end()) {
        return corner_error(word);
      }
      const std::int64_t count = static_cast<std::int64_t>(mesh_.positions.size());
      const std::int64_t vertex = corner->vertex;
      const std::int64_t index = vertex > 0 ? vertex - 1 : vertex + count;
      // Faces may stand before their vertices, which are counted then, once.
      if (vertex == 0 || index < 0 || (index >= count && index >= vertices_in_file())) {
        return vertex_error(begin, vertex);
      }
      corners_.push_back({static_cast<Index>(index), absolute(corner->texture, texture_count_),
                          absolute(corner->normal, normal_count_)});
    }
    const auto place = [&] { return source_.place_in_line(begin); };
    if (corners_.size() < 3) {
      reading_.notes.add("short_face", place,
                         "a face of " + counted(corners_.size(), "corner") +
                             " is no surface and is left out");
      return success();
    }
    if (drop_repeated_corners(corners_, [](const Corner& c) { return c.vertex; })) {
      reading_.notes.add("repeated_corner", place, repeated_corner_note);
    }
    keep_face();
    return success();
  }

  void keep_face() {
    vertices_.clear();
    for (const Corner& corner : corners_) {
      vertices_.push_back(corner.vertex);
      if (normals_ != nullptr || attributes_ != nullptr) {
        normal_of_corner_.push_back(corner.normal);
      }
      if (attributes_ != nullptr) {
        attributes_->texture_of_corner.push_back(corner.texture);
      }
    }
    if (attributes_ != nullptr) {
      attributes_->face_materials.push_back(material_);
    }
    mesh_.add_face(vertices_);
    add_to_group();
  }

  // From 0; `none` for what is not there. Whether it is too large only the end of the file tells.
  static Index absolute(std::int64_t number, std::int64_t count) {
    const std::int64_t index = number > 0 ? number - 1 : number + count;
    return number != 0 && index >= 0 && index < none ? static_cast<Index>(index) : none;
  }

  Error corner_error(std::size_t word) {
    cursor_.move_to(word);
    const std::string_view text = cursor_.peek_word();
    const std::string_view digits = text.substr(0, text.find('/'));
    const bool is_beyond =
        !digits.empty() && digits.size() > 18 &&
        digits.find_first_not_of("0123456789", digits[0] == '-' ? 1 : 0) == std::string_view::npos;
    if (is_beyond) {
      return source_.error_in_line(word,
                                   no_such_vertex("face", one_line(digits, 40),
                                                  static_cast<std::size_t>(vertices_in_file())));
    }
    if (has_thousands_separators(digits)) {
      return source_.error_in_line(
          word, in_quotes(text) +
                    " has a thousands separator, which OBJ does not know; switch the grouping of "
                    "digits off where the file was written, or remove the separators from the "
                    "lines of faces (exporting with the same setting gives the same file)");
    }
    return source_.error_in_line(word, in_quotes(text) + " is not a corner of a face" +
                                           std::string(export_again));
  }

  Error vertex_error(std::size_t begin, std::int64_t vertex) {
    if (vertex == 0) {
      return source_.error_in_line(begin, "face refers to vertex 0, but OBJ counts from 1; add 1 "
                                          "to the corners of all faces where they are written");
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
      TextCursor ahead(source_);
      vertices_in_file_ = 0;
      while (ahead.next_word_of_file()) {
        *vertices_in_file_ += begin_obj_statement(ahead) == "v" ? 1 : 0;
        ahead.next_line();
        ahead.set_backslash(TextCursor::Backslash::is_text);
      }
    }
    return *vertices_in_file_;
  }

  // A new object begins without a group; a group belongs to the object under way.
  void begin_group(bool is_object, std::string_view name) {
    (is_object ? object_ : group_) = name;
    if (is_object) {
      group_ = {};
    }
    is_named_ = true;
    group_index_.reset();
  }

  // Groups are counted when a face comes, so that none is empty. Faces before the first name are
  // in a group of their own if there is any other.
  void add_to_group() {
    if (!is_named_) {
      return;
    }
    if (!group_index_) {
      if (mesh_.face_groups.empty() && mesh_.face_count() > 1) {
        add_group({}, {});
        mesh_.face_groups.assign(mesh_.face_count() - 1, 0);
      }
      group_index_ = add_group(object_, group_);
    }
    mesh_.face_groups.push_back(*group_index_);
  }

  Index add_group(std::string_view object, std::string_view group) {
    std::string key(object);
    key.append(1, '\n').append(group); // no name holds a line end
    const auto [entry, is_new] =
        group_indices_.emplace(std::move(key), static_cast<Index>(mesh_.group_names.size()));
    if (is_new) {
      const std::string_view name = group.empty() ? object : group;
      mesh_.group_names.emplace_back(name.empty() ? "default" : name);
      if (attributes_ != nullptr) {
        attributes_->group_objects.emplace_back(group.empty() ? std::string_view() : object);
      }
    }
    return entry->second;
  }

  Reading& reading_;
  FileNormals* normals_;       // or null
  MeshAttributes* attributes_; // or null
  Source source_;
  TextCursor cursor_;
  PolygonMesh mesh_;
  std::vector<Corner> corners_;
  std::vector<Index> vertices_;
  bool has_surfaces_ = false;
  std::optional<std::size_t> unknown_; // where the first unknown statement stands
  std::optional<std::int64_t> vertices_in_file_;
  std::vector<Vec3> normal_lines_;      // kept only if asked for, as the next
  std::vector<Index> normal_of_corner_; // indices of lines
  std::int64_t normal_count_ = 0;
  std::int64_t texture_count_ = 0;
  std::string_view object_;
  std::string_view group_;
  bool is_named_ = false; // an object or a group has been named
  std::optional<Index> group_index_;
  std::unordered_map<std::string, Index> group_indices_;
  Index material_ = none;
  std::unordered_map<std::string, Index> material_indices_;
};

} // namespace

Result<PolygonMesh> read_obj(const Source& source, Reading& reading) {
  return ObjReader(source, reading).read();
}

} // namespace cagewright
