#include "io/ply_values.h"
#include "io/readers.h"
#include "io/repeated_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>

namespace cagewright {
namespace {

// The largest value of an integer type, which stands for 1 in colours; 1 for floats.
double unit_of(PlyType type) {
  switch (type) {
  case PlyType::int8:
    return std::numeric_limits<std::int8_t>::max();
  case PlyType::uint8:
    return std::numeric_limits<std::uint8_t>::max();
  case PlyType::int16:
    return std::numeric_limits<std::int16_t>::max();
  case PlyType::uint16:
    return std::numeric_limits<std::uint16_t>::max();
  case PlyType::int32:
    return std::numeric_limits<std::int32_t>::max();
  case PlyType::uint32:
    return std::numeric_limits<std::uint32_t>::max();
  case PlyType::int64:
  case PlyType::uint64:
    return 0x1p63;
  case PlyType::float32:
  case PlyType::float64:
    return 1;
  }
  return 1;
}

template <class Values> class PlyReader {
public:
  PlyReader(const Source& source, const PlyHeader& header, Values values, Reading& reading)
      : reading_(reading), attributes_(reading.attributes), source_(source), header_(header),
        values_(std::move(values)) {}

  Result<PolygonMesh> read() {
    const auto vertices =
        std::find_if(header_.elements.begin(), header_.elements.end(),
                     [](const PlyElement& element) { return element.name == "vertex"; });
    if (vertices == header_.elements.end()) {
      return source_.error("the header has no element 'vertex'; check that this is a model" +
                           std::string(", or export it again"));
    }
    vertices_ = vertices->count;
    if (vertices_ > std::numeric_limits<Index>::max()) {
      return too_many_vertices(source_, vertices_);
    }
    for (const PlyElement& element : header_.elements) {
      if (const Status status = read_element(element); !status) {
        return status.error();
      }
    }
    if (mesh_.face_count() == 0) {
      return no_faces(source_);
    }
    if (!values_.at_end()) {
      reading_.notes.add(
          "trailing_bytes", [&] { return values_.place(); },
          "what stands behind the last element of the header is left out");
    }
    if (attributes_ != nullptr) {
      finish_attributes();
    }
    return std::move(mesh_);
  }

private:
  Status read_element(const PlyElement& element) {
    if (const Status status = check_size(element); !status) {
      return status;
    }
    if (element.name == "vertex" && !vertices_done_) {
      vertices_done_ = true;
      return read_vertices(element);
    }
    if (element.name == "face" && element.count != 0) {
      return read_lists(element, [this, &element] { return add_face(element); });
    }
    if (element.name == "tristrips" && element.count != 0) {
      return read_lists(element, [this] { return add_strip(); });
    }
    if (attributes_ != nullptr && element.count != 0) {
      attributes_->others.push_back("the element " + in_quotes(element.name));
    }
    return read_rows(element, {}, [] { return success(); });
  }

  // The count in a damaged header may be anything: nothing is allocated before this.
  Status check_size(const PlyElement& element) {
    std::size_t row = 0;
    for (const PlyProperty& property : element.properties) {
      row += Values::least_size(property.count_type.value_or(property.type));
    }
    if (row != 0 && element.count > values_.remaining() / row) {
      return source_.error("the header promises " + counted(element.count, "row") +
                           " of the element " + in_quotes(element.name) +
                           ", but the file ends before; it is cut short" +
                           std::string(export_again));
    }
    return success();
  }

  // Calls use() for each row, with the row's values in values_of_row_ (0 for a list), the list of
  // the given property in list_, and that of texture_list_ in texture_of_row_.
  template <class Use>
  Status read_rows(const PlyElement& element, std::optional<std::size_t> list, Use use) {
    values_of_row_.assign(element.properties.size(), 0);
    // Rows without properties take no room in the file, so that any number of them may be promised.
    const std::size_t rows = element.properties.empty() ? 0 : element.count;
    for (row_ = 0; row_ < rows; ++row_) {
      if (!values_.begin_row()) {
        return values_.error("the file ends after " + std::to_string(row_) + " of " +
                             std::to_string(element.count) + " rows of the element " +
                             in_quotes(element.name) + "; it is cut short" +
                             std::string(export_again));
      }
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (property.count_type) {
          std::vector<double>* kept = list == i ? &list_ : nullptr;
          kept = list && texture_list_ == i ? &texture_of_row_ : kept;
          const Status status = read_list(element, property, kept);
          if (!status) {
            return status;
          }
        } else if (const std::optional<double> value = values_.value(property.type)) {
          values_of_row_[i] = *value;
        } else {
          return values_.bad_value(row_name(element));
        }
      }
      if (const Status status = use(); !status) {
        return status;
      }
      values_.end_row();
    }
    return success();
  }

  // Reads a list, into `kept` if that is given.
  Status read_list(const PlyElement& element, const PlyProperty& property,
                   std::vector<double>* kept) {
    const std::optional<double> count = values_.value(*property.count_type);
    if (!count) {
      return values_.bad_value(row_name(element));
    }
    if (!(*count >= 0) || *count != std::floor(*count)) {
      return values_.error("a list cannot have " + number_text(*count) + " items" +
                           std::string(export_again));
    }
    const double room =
        static_cast<double>(values_.remaining() / Values::least_size(property.type));
    if (*count > room) {
      return values_.error("a list promises " + number_text(*count) +
                           " items, but the file ends before; it is cut short" +
                           std::string(export_again));
    }
    if (kept != nullptr) {
      kept->clear();
    }
    for (auto left = static_cast<std::size_t>(*count); left != 0; --left) {
      const std::optional<double> value = values_.value(property.type);
      if (!value) {
        return values_.bad_value(row_name(element));
      }
      if (kept != nullptr) {
        kept->push_back(*value);
      }
    }
    return success();
  }

  Status read_vertices(const PlyElement& element) {
    std::array<std::size_t, 3> axes{};
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr std::array<std::string_view, 3> names = {"x", "y", "z"};
      const std::optional<std::size_t> axis = find_scalar(element, names[i]);
      if (!axis) {
        return source_.error("the element 'vertex' has no property " + in_quotes(names[i]) +
                             std::string(export_again));
      }
      axes[i] = *axis;
    }
    const std::array<std::optional<std::size_t>, 4> channels = {
        find_channel(element, "red"), find_channel(element, "green"), find_channel(element, "blue"),
        find_channel(element, "alpha")};
    const bool has_color = channels[0] && channels[1] && channels[2];
    mesh_.positions.reserve(element.count);
    if (attributes_ != nullptr) {
      plan_vertex_values(element, axes, channels, has_color);
    }
    return read_rows(element, {}, [&]() -> Status {
      const Vec3 p(values_of_row_[axes[0]], values_of_row_[axes[1]], values_of_row_[axes[2]]);
      if (!p.allFinite()) {
        return values_.error("vertex " + std::to_string(row_) +
                             " has a coordinate that is not a finite number" +
                             std::string(export_again));
      }
      mesh_.positions.push_back(p);
      if (attributes_ != nullptr) {
        keep_vertex_values();
      }
      if (has_color) {
        std::array<float, 4>& color = mesh_.colors.emplace_back();
        for (std::size_t i = 0; i < 4; ++i) {
          color[i] = channels[i] ? channel_value(element, *channels[i]) : 1.0F;
        }
      }
      return success();
    });
  }

  static std::optional<std::size_t> find_scalar(const PlyElement& element, std::string_view name) {
    const std::optional<std::size_t> found = element.find(name);
    return found && !element.properties[*found].count_type ? found : std::nullopt;
  }

  static std::optional<std::size_t> find_channel(const PlyElement& element, std::string_view name) {
    const std::optional<std::size_t> found = find_scalar(element, name);
    return found ? found : find_scalar(element, "diffuse_" + std::string(name));
  }

  [[nodiscard]] float channel_value(const PlyElement& element, std::size_t property) const {
    const double value = values_of_row_[property] / unit_of(element.properties[property].type);
    return value > 0 ? static_cast<float>(std::min(value, 1.0)) : 0.0F; // nan becomes 0
  }

  // Which properties of the vertices become what.
  void plan_vertex_values(const PlyElement& element, const std::array<std::size_t, 3>& axes,
                          const std::array<std::optional<std::size_t>, 4>& channels,
                          bool has_color) {
    std::vector<bool> is_used(element.properties.size(), false);
    const auto use = [&](std::optional<std::size_t> property) {
      is_used[*property] = true;
      return *property;
    };
    for (const std::size_t axis : axes) {
      use(axis);
    }
    for (const auto& channel : channels) {
      if (has_color && channel) {
        use(channel);
      }
    }
    const auto nx = find_scalar(element, "nx");
    const auto ny = find_scalar(element, "ny");
    const auto nz = find_scalar(element, "nz");
    if (nx && ny && nz) {
      normal_ = {use(nx), use(ny), use(nz)};
    }
    constexpr std::array<std::array<std::string_view, 2>, 4> texture_names = {
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};
    for (const auto& [first, second] : texture_names) {
      const auto u = find_scalar(element, first);
      const auto v = find_scalar(element, second);
      if (u && v && !texture_) {
        texture_ = {use(u), use(v)};
      }
    }
    for (std::size_t i = 0; i < is_used.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.count_type) {
        attributes_->others.push_back("the lists " + in_quotes(property.name) + " of vertices");
      } else if (!is_used[i]) {
        kept_.push_back(i);
        attributes_->vertex_values.push_back(
            {std::string(property.name), is_integer_type(property.type), {}});
      }
    }
  }

  void keep_vertex_values() {
    if (normal_) {
      attributes_->normals.emplace_back(values_of_row_[(*normal_)[0]],
                                        values_of_row_[(*normal_)[1]],
                                        values_of_row_[(*normal_)[2]]);
    }
    if (texture_) {
      attributes_->texture_points.push_back(
          {values_of_row_[(*texture_)[0]], values_of_row_[(*texture_)[1]]});
    }
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      attributes_->vertex_values[i].values.push_back(values_of_row_[kept_[i]]);
    }
  }

  // Strips have no faces of their own that values could belong to.
  void name_strip_values(const PlyElement& element, std::size_t corners) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (i != corners) {
        attributes_->others.push_back("the values " + in_quotes(element.properties[i].name) +
                                      " of strips");
      }
    }
  }

  void plan_face_values(const PlyElement& element, std::size_t corners) {
    if (const auto texture = element.find("texcoord");
        texture && texture != corners && element.properties[*texture].count_type) {
      texture_list_ = texture;
    }
    const auto red = find_channel(element, "red");
    const auto green = find_channel(element, "green");
    const auto blue = find_channel(element, "blue");
    if (red && green && blue) {
      face_color_ = {*red, *green, *blue};
    }
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const bool is_color = face_color_ && std::find(face_color_->begin(), face_color_->end(), i) !=
                                               face_color_->end();
      if (i == texture_list_) {
        continue;
      }
      if (property.count_type && i != corners) {
        attributes_->others.push_back("the lists " + in_quotes(property.name) + " of faces");
      } else if (i != corners && !is_color && property.name != "alpha") {
        kept_of_face_.push_back(i);
        attributes_->face_values.push_back(
            {std::string(property.name), is_integer_type(property.type), {}});
      }
    }
  }

  void keep_face_values(const PlyElement& element) {
    if (face_color_) {
      std::array<float, 4>& color = attributes_->face_colors.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        color[i] = channel_value(element, (*face_color_)[i]);
      }
      color[3] = 1;
    }
    for (std::size_t i = 0; i < kept_of_face_.size(); ++i) {
      attributes_->face_values[i].values.push_back(values_of_row_[kept_of_face_[i]]);
    }
  }

  // Texture points of a face's corners, two numbers for each: all of them, or the corner has none.
  void keep_texture_of_corners(std::span<const std::size_t> items) {
    std::vector<Index>& of_corner = attributes_->texture_of_corner;
    of_corner.resize(mesh_.corners().size() - items.size(), MeshAttributes::none); // strips'
    const bool fits = texture_of_row_.size() == 2 * list_.size();
    for (const std::size_t item : items) {
      of_corner.push_back(fits ? static_cast<Index>(attributes_->texture_points.size())
                               : MeshAttributes::none);
      if (fits) {
        attributes_->texture_points.push_back(
            {texture_of_row_[2 * item], texture_of_row_[2 * item + 1]});
      }
    }
  }

  // Values of faces where others, of strips, have none are of no use to a mesh.
  void drop_values_of_some_faces() {
    if (!attributes_->texture_of_corner.empty()) {
      attributes_->texture_of_corner.resize(mesh_.corners().size(), MeshAttributes::none);
    }
    if (!attributes_->face_colors.empty() &&
        attributes_->face_colors.size() != mesh_.face_count()) {
      attributes_->face_colors.clear();
      attributes_->others.emplace_back("face colours");
    }
    std::erase_if(attributes_->face_values, [&](const NamedValues& values) {
      const bool is_short = values.values.size() != mesh_.face_count();
      if (is_short) {
        attributes_->others.push_back("the values " + in_quotes(values.name) + " of faces");
      }
      return is_short;
    });
  }

  void finish_attributes() {
    drop_values_of_some_faces();
    for (const std::string_view comment : header_.comments) {
      attributes_->comments.emplace_back(comment);
    }
    if (normal_) {
      attributes_->normal_of_corner.assign(mesh_.corners().begin(), mesh_.corners().end());
      for (Index& corner : attributes_->normal_of_corner) {
        corner = attributes_->normals[corner].allFinite() ? corner : MeshAttributes::none;
      }
    }
    if (texture_ && attributes_->texture_of_corner.empty()) {
      attributes_->texture_of_corner.assign(mesh_.corners().begin(), mesh_.corners().end());
    }
  }

  static bool is_integer_type(PlyType type) {
    return type != PlyType::float32 && type != PlyType::float64;
  }

  template <class Use> Status read_lists(const PlyElement& element, Use use) {
    std::optional<std::size_t> corners = element.find("vertex_indices");
    corners = corners ? corners : element.find("vertex_index");
    corners = corners ? corners : only_list(element);
    if (!corners || !element.properties[*corners].count_type) {
      return source_.error("the element " + in_quotes(element.name) +
                           " has no list 'vertex_indices'" + std::string(export_again));
    }
    if (attributes_ != nullptr) {
      element.name == "face" ? plan_face_values(element, *corners)
                             : name_strip_values(element, *corners);
    }
    const Status status = read_rows(element, corners, use);
    texture_list_.reset(); // of this element
    return status;
  }

  // Under whatever name: a face with one list of integers has its corners there.
  static std::optional<std::size_t> only_list(const PlyElement& element) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.count_type && is_integer_type(property.type)) {
        if (found) {
          return std::nullopt;
        }
        found = i;
      }
    }
    return found;
  }

  Status add_face(const PlyElement& element) {
    items_.clear();
    for (const double value : list_) {
      if (!is_vertex(value)) {
        return no_vertex(value);
      }
      items_.push_back(items_.size());
    }
    const auto place = [&] { return values_.place(); };
    if (items_.size() < 3) {
      reading_.notes.add("short_face", place,
                         "face " + std::to_string(row_) + " has " +
                             counted(items_.size(), "corner") + ", is no surface and is left out");
      return success();
    }
    if (drop_repeated_corners(items_, [&](std::size_t i) { return list_[i]; })) {
      reading_.notes.add("repeated_corner", place, repeated_corner_note);
    }
    corners_.clear();
    for (const std::size_t item : items_) {
      corners_.push_back(static_cast<Index>(list_[item]));
    }
    mesh_.add_face(corners_);
    if (attributes_ != nullptr) {
      keep_face_values(element);
    }
    if (texture_list_) {
      keep_texture_of_corners(items_);
    }
    return success();
  }

  // A list of strips with -1 between them; every other triangle of a strip runs the other way
  // round. Triangles with a repeated corner only turn the strip round a bend.
  Status add_strip() {
    std::size_t begin = 0; // of the strip under way
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1) {
        begin = i + 1;
        continue;
      }
      if (!is_vertex(list_[i])) {
        return no_vertex(list_[i]);
      }
      if (i < begin + 2) {
        continue;
      }
      const auto a = static_cast<Index>(list_[i - 2]);
      const auto b = static_cast<Index>(list_[i - 1]);
      const auto c = static_cast<Index>(list_[i]);
      if (a != b && b != c && c != a) {
        (i - begin) % 2 == 0 ? mesh_.add_face({a, b, c}) : mesh_.add_face({b, a, c});
      }
    }
    return success();
  }

  [[nodiscard]] bool is_vertex(double value) const {
    return value >= 0 && value < static_cast<double>(vertices_) && value == std::floor(value);
  }

  [[nodiscard]] Error no_vertex(double value) const {
    return values_.error(
        no_such_vertex("face " + std::to_string(row_), number_text(value), vertices_));
  }

  [[nodiscard]] std::string row_name(const PlyElement& element) const {
    return "row " + std::to_string(row_) + " of the element " + in_quotes(element.name);
  }

  static std::string number_text(double value) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
  }

  Reading& reading_;
  MeshAttributes* attributes_; // or null
  Source source_;
  const PlyHeader& header_;
  Values values_;
  PolygonMesh mesh_;
  std::size_t vertices_ = 0; // as the header says, so that faces may come first
  bool vertices_done_ = false;
  std::size_t row_ = 0;
  std::vector<double> values_of_row_;
  std::vector<double> list_;
  std::vector<double> texture_of_row_;
  std::vector<std::size_t> items_; // of list_ that are corners of the face under way
  std::vector<Index> corners_;
  std::optional<std::array<std::size_t, 3>> normal_; // properties, as the next
  std::optional<std::array<std::size_t, 2>> texture_;
  std::optional<std::size_t> texture_list_; // of the faces, one point for each corner
  std::optional<std::array<std::size_t, 3>> face_color_;
  std::vector<std::size_t> kept_;         // as vertex_values
  std::vector<std::size_t> kept_of_face_; // as face_values
};

} // namespace

Result<PolygonMesh> read_ply(const Source& source, Reading& reading) {
  const Result<PlyHeader> header = read_ply_header(source);
  if (!header) {
    return header.error();
  }
  if (header->encoding == PlyHeader::Encoding::text) {
    return PlyReader(source, *header, PlyText(source, *header), reading).read();
  }
  const std::endian order = header->encoding == PlyHeader::Encoding::little_endian
                                ? std::endian::little
                                : std::endian::big;
  return PlyReader(source, *header, PlyBinary(source, header->end, order), reading).read();
}

} // namespace cagewright
