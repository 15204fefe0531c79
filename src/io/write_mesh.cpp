#include <cagewright/io/write_mesh.h>

#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/source.h"
#include "io/write_gltf.h"
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace cagewright {
namespace {

// A text under construction: one string, no streams, no locale.
class Text {
public:
  explicit Text(std::size_t expected) { text_.reserve(expected); }

  Text& operator<<(std::string_view part) {
    text_.append(part);
    return *this;
  }
  Text& operator<<(char c) {
    text_.push_back(c);
    return *this;
  }
  Text& operator<<(const Vec3& p) {
    return number(p.x()) << ' ', number(p.y()) << ' ', number(p.z());
  }

  // The shortest digits that read back as the same number.
  template <class Number> Text& number(Number value) {
    append_number(text_, value);
    return *this;
  }

  // The bytes of a number, lowest first.
  template <class Number> Text& binary(Number value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) {
      std::reverse(bytes, bytes + sizeof value);
    }
    text_.append(bytes, sizeof value);
    return *this;
  }

  std::string take() && { return std::move(text_); }

private:
  std::string text_;
};

std::size_t expected_size(const PolygonMesh& mesh) {
  return 256 + 64 * mesh.positions.size() + 12 * mesh.corners().size();
}

// A name as one line of text.
std::string label(std::string_view name) {
  return name.empty() ? std::string("default") : one_line(name, name.size());
}

/// The attributes as a format without corners of its own can hold them: one for each vertex.
struct VertexDress {
  std::vector<Vec3> normals;                  // V, or none
  std::vector<std::array<double, 2>> texture; // V, or none
};

/// The value of each vertex where all its corners agree; none where some differ or have none.
template <class Value>
std::vector<Value> value_of_vertices(const PolygonMesh& mesh, const std::vector<Value>& values,
                                     const std::vector<Index>& of_corner, const Value& nothing) {
  std::vector<Value> result;
  if (of_corner.empty()) {
    return result;
  }
  std::vector<Index> of_vertex(mesh.positions.size(), MeshAttributes::none);
  for (std::size_t c = 0; c < of_corner.size(); ++c) {
    Index& found = of_vertex[mesh.corners()[c]];
    if (of_corner[c] == MeshAttributes::none ||
        (found != MeshAttributes::none && values[found] != values[of_corner[c]])) {
      return result;
    }
    found = of_corner[c];
  }
  for (const Index i : of_vertex) {
    result.push_back(i == MeshAttributes::none ? nothing : values[i]);
  }
  return result;
}

VertexDress vertex_dress(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  return {value_of_vertices(mesh, attributes.normals, attributes.normal_of_corner, Vec3(0, 0, 0)),
          value_of_vertices(mesh, attributes.texture_points, attributes.texture_of_corner,
                            std::array<double, 2>{0, 0})};
}

// "v", "v/vt", "v//vn" or "v/vt/vn", from 1.
void append_corner(Text& text, const MeshAttributes& attributes, std::size_t corner, Index vertex) {
  const auto of = [&](const std::vector<Index>& list) {
    return list.empty() ? MeshAttributes::none : list[corner];
  };
  const Index texture = of(attributes.texture_of_corner);
  const Index normal = of(attributes.normal_of_corner);
  (text << ' ').number(std::uint64_t{vertex} + 1);
  if (texture != MeshAttributes::none || normal != MeshAttributes::none) {
    text << '/';
  }
  if (texture != MeshAttributes::none) {
    text.number(std::uint64_t{texture} + 1);
  }
  if (normal != MeshAttributes::none) {
    (text << '/').number(std::uint64_t{normal} + 1);
  }
}

// The statements that change between a face and the one before it.
void append_face_state(Text& text, const PolygonMesh& mesh, const MeshAttributes& attributes,
                       std::size_t f) {
  const auto changes = [f](const std::vector<Index>& of_face) {
    return !of_face.empty() && (f == 0 || of_face[f] != of_face[f - 1]);
  };
  if (changes(mesh.face_groups)) {
    const Index group = mesh.face_groups[f];
    const std::string_view object = group < attributes.group_objects.size()
                                        ? std::string_view(attributes.group_objects[group])
                                        : std::string_view();
    if (!object.empty()) {
      text << "o " << label(object) << "\ng " << label(mesh.group_names[group]) << '\n';
    } else {
      text << "o " << label(mesh.group_names[group]) << '\n';
    }
  }
  if (changes(attributes.face_materials)) {
    const Index material = attributes.face_materials[f];
    if (material != MeshAttributes::none) {
      text << "usemtl " << label(attributes.material_names[material]) << '\n';
    } else if (f > 0) {
      text << "usemtl\n";
    }
  }
}

std::string format_obj(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  Text text(expected_size(mesh));
  for (const std::string& comment : attributes.comments) {
    text << "# " << one_line(comment, comment.size()) << '\n';
  }
  for (const std::string& file : attributes.material_files) {
    text << "mtllib " << one_line(file, file.size()) << '\n';
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    text << "v " << mesh.positions[v];
    if (!mesh.colors.empty()) {
      for (int channel = 0; channel < 3; ++channel) {
        (text << ' ').number(mesh.colors[v][channel]);
      }
    }
    text << '\n';
  }
  for (const auto& [u, v] : attributes.texture_points) {
    (text << "vt ").number(u) << ' ';
    text.number(v) << '\n';
  }
  for (const Vec3& normal : attributes.normals) {
    text << "vn " << normal << '\n';
  }
  std::size_t corner = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    append_face_state(text, mesh, attributes, f);
    text << 'f';
    for (const Index vertex : mesh.face(f)) {
      append_corner(text, attributes, corner++, vertex);
    }
    text << '\n';
  }
  return std::move(text).take();
}

std::string format_off(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  const VertexDress dress = vertex_dress(mesh, attributes);
  Text text(expected_size(mesh));
  text << (dress.texture.empty() ? "" : "ST") << (mesh.colors.empty() ? "" : "C")
       << (dress.normals.empty() ? "" : "N") << "OFF\n";
  text.number(mesh.positions.size()) << ' ';
  text.number(mesh.face_count()) << " 0\n";
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    text << mesh.positions[v];
    if (!dress.normals.empty()) {
      text << ' ' << dress.normals[v];
    }
    if (!mesh.colors.empty()) {
      for (const float channel : mesh.colors[v]) {
        (text << ' ').number(channel);
      }
    }
    if (!dress.texture.empty()) {
      (text << ' ').number(dress.texture[v][0]) << ' ';
      text.number(dress.texture[v][1]);
    }
    text << '\n';
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    text.number(mesh.face(f).size());
    for (const Index corner : mesh.face(f)) {
      (text << ' ').number(corner);
    }
    if (!attributes.face_colors.empty()) {
      for (const float channel : attributes.face_colors[f]) {
        (text << ' ').number(channel);
      }
    }
    text << '\n';
  }
  return std::move(text).take();
}

std::string format_stl(const PolygonMesh& mesh) {
  const std::vector<Triangle> triangles = triangulate(mesh).triangles;
  Text text(256 + 300 * triangles.size());
  text << "solid cagewright\n";
  for (const Triangle& t : triangles) {
    const Vec3& a = mesh.positions[t[0]];
    const Vec3& b = mesh.positions[t[1]];
    const Vec3& c = mesh.positions[t[2]];
    text << "facet normal " << facet_normal(a, b, c) << "\nouter loop\n";
    text << "vertex " << a << "\nvertex " << b << "\nvertex " << c << "\nendloop\nendfacet\n";
  }
  text << "endsolid cagewright\n";
  return std::move(text).take();
}

// How a PLY file stores what varies with the mesh.
struct PlyTypes {
  bool byte_colors;    // every channel is a whole number of 255ths: what most programs expect
  bool wide_counts;    // some face has more than 255 corners
  bool signed_indices; // all vertex numbers fit an int: what most programs expect
};

PlyTypes ply_types(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  PlyTypes types{true, false, mesh.positions.size() <= std::size_t{1} << 31U};
  for (const auto* colors : {&mesh.colors, &attributes.face_colors}) {
    for (const auto& color : *colors) {
      types.byte_colors &= std::all_of(color.begin(), color.end(), [](float channel) {
        return std::round(channel * 255) / 255 == channel;
      });
    }
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    types.wide_counts |= mesh.face(f).size() > (attributes.texture_of_corner.empty() ? 255 : 127);
  }
  return types;
}

std::uint8_t to_byte(float channel) {
  return static_cast<std::uint8_t>(std::lround(channel * 255));
}

/// Values as text or as bytes: what a PLY file has of each.
class PlyWriter {
public:
  PlyWriter(const PolygonMesh& mesh, const MeshAttributes& attributes, bool ascii)
      : mesh_(mesh), attributes_(attributes), dress_(vertex_dress(mesh, attributes)),
        types_(ply_types(mesh, attributes)), ascii_(ascii),
        has_corner_texture_(dress_.texture.empty() && !attributes.texture_of_corner.empty()),
        text_(expected_size(mesh)) {}

  std::string write() && {
    write_header();
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      write_vertex(v);
    }
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      write_face(f, corner);
    }
    return std::move(text_).take();
  }

private:
  void write_header() {
    text_ << "ply\nformat " << (ascii_ ? "ascii" : "binary_little_endian") << " 1.0\n";
    for (const std::string& comment : attributes_.comments) {
      text_ << "comment " << one_line(comment, comment.size()) << '\n';
    }
    text_ << "element vertex ";
    text_.number(mesh_.positions.size());
    text_ << "\nproperty double x\nproperty double y\nproperty double z\n";
    if (!dress_.normals.empty()) {
      text_ << "property double nx\nproperty double ny\nproperty double nz\n";
    }
    write_colors_in_header(mesh_.colors);
    if (!dress_.texture.empty()) {
      text_ << "property double s\nproperty double t\n";
    }
    write_values_in_header(attributes_.vertex_values);
    text_ << "element face ";
    text_.number(mesh_.face_count());
    text_ << "\nproperty list " << count_type() << (types_.signed_indices ? " int" : " uint")
          << " vertex_indices\n";
    if (has_corner_texture_) {
      text_ << "property list " << count_type() << " double texcoord\n";
    }
    write_colors_in_header(attributes_.face_colors);
    write_values_in_header(attributes_.face_values);
    text_ << "end_header\n";
  }

  [[nodiscard]] const char* count_type() const { return types_.wide_counts ? "uint" : "uchar"; }

  void write_colors_in_header(const std::vector<std::array<float, 4>>& colors) {
    if (!colors.empty()) {
      for (const char* channel : {"red", "green", "blue", "alpha"}) {
        text_ << "property " << (types_.byte_colors ? "uchar " : "float ") << channel << '\n';
      }
    }
  }

  void write_values_in_header(const std::vector<NamedValues>& all) {
    for (const NamedValues& values : all) {
      text_ << "property " << (is_int(values) ? "int " : "double ") << values.name << '\n';
    }
  }

  // Wider integers are exact as doubles, up to 2^53.
  static bool is_int(const NamedValues& values) {
    return values.is_integer && std::all_of(values.values.begin(), values.values.end(),
                                            [](double value) { return std::abs(value) < 0x1p31; });
  }

  void write_vertex(std::size_t v) {
    write_vector(mesh_.positions[v]);
    if (!dress_.normals.empty()) {
      write_vector(dress_.normals[v]);
    }
    write_color(mesh_.colors, v);
    if (!dress_.texture.empty()) {
      write(dress_.texture[v][0]);
      write(dress_.texture[v][1]);
    }
    write_values(attributes_.vertex_values, v);
    end_row();
  }

  void write_face(std::size_t f, std::size_t& corner) {
    const std::size_t count = mesh_.face(f).size();
    write_count(count);
    for (const Index vertex : mesh_.face(f)) {
      write(vertex);
    }
    if (has_corner_texture_) {
      write_count(2 * count);
      for (std::size_t i = 0; i < count; ++i, ++corner) {
        const Index texture = attributes_.texture_of_corner[corner];
        const std::array<double, 2> point = texture == MeshAttributes::none
                                                ? std::array<double, 2>{0, 0}
                                                : attributes_.texture_points[texture];
        write(point[0]);
        write(point[1]);
      }
    }
    write_color(attributes_.face_colors, f);
    write_values(attributes_.face_values, f);
    end_row();
  }

  void write_count(std::size_t count) {
    types_.wide_counts ? write(static_cast<std::uint32_t>(count))
                       : write(static_cast<std::uint8_t>(count));
  }

  void write_vector(const Vec3& vector) {
    for (const double x : vector) {
      write(x);
    }
  }

  void write_color(const std::vector<std::array<float, 4>>& colors, std::size_t i) {
    if (!colors.empty()) {
      for (const float channel : colors[i]) {
        types_.byte_colors ? write(to_byte(channel)) : write(channel);
      }
    }
  }

  void write_values(const std::vector<NamedValues>& all, std::size_t i) {
    for (const NamedValues& values : all) {
      is_int(values) ? write(static_cast<std::int32_t>(values.values[i])) : write(values.values[i]);
    }
  }

  template <class Number> void write(Number value) {
    if (!ascii_) {
      text_.binary(value);
      return;
    }
    if (!at_row_begin_) {
      text_ << ' ';
    }
    at_row_begin_ = false;
    text_.number(value);
  }

  void end_row() {
    if (ascii_) {
      text_ << '\n';
    }
    at_row_begin_ = true;
  }

  const PolygonMesh& mesh_;
  const MeshAttributes& attributes_;
  VertexDress dress_;
  PlyTypes types_;
  bool ascii_;
  bool has_corner_texture_;
  Text text_;
  bool at_row_begin_ = true;
};

/// What the format cannot hold, in words.
std::vector<std::string> lost_in(MeshFormat format, const PolygonMesh& mesh,
                                 const MeshAttributes& attributes) {
  const bool obj = format == MeshFormat::obj;
  const bool ply = format == MeshFormat::ply;
  const bool off = format == MeshFormat::off;
  const bool gltf = format == MeshFormat::gltf;
  const VertexDress dress = ply || off ? vertex_dress(mesh, attributes) : VertexDress();
  const bool alpha =
      std::any_of(mesh.colors.begin(), mesh.colors.end(), [](const auto& c) { return c[3] != 1; });
  std::vector<std::string> lost;
  const auto lose = [&](bool has, bool kept, const std::string& what) {
    if (has && !kept) {
      lost.push_back(what);
    }
  };
  lose(mesh.corners().size() > 3 * mesh.face_count(), obj || ply || off,
       "faces of more than three corners (cut into triangles)");
  lose(!attributes.texture_of_corner.empty(), obj || ply || gltf || (off && !dress.texture.empty()),
       "texture coordinates");
  lose(!attributes.normal_of_corner.empty(), obj || gltf || !dress.normals.empty(),
       ply || off ? "normals of hard edges" : "normals");
  lose(!attributes.face_materials.empty(), obj || gltf, "materials");
  lose(!attributes.material_files.empty(), obj || !gltf, "colours of materials");
  lose(!mesh.face_groups.empty(), obj || gltf, "groups");
  lose(!mesh.colors.empty(), obj || ply || off || gltf, "vertex colours");
  lose(alpha, !obj, "the alpha of colours");
  lose(!attributes.face_colors.empty(), ply || off, "face colours");
  for (const NamedValues& values : attributes.vertex_values) {
    lose(true, ply, "the values " + in_quotes(values.name) + " of vertices");
  }
  for (const NamedValues& values : attributes.face_values) {
    lose(true, ply, "the values " + in_quotes(values.name) + " of faces");
  }
  lost.insert(lost.end(), attributes.others.begin(), attributes.others.end());
  return lost;
}

} // namespace

Result<FormattedMesh> format_mesh(const PolygonMesh& mesh, const MeshAttributes& attributes,
                                  MeshFormat format, const WriteOptions& options) {
  const auto wrong = std::find_if(mesh.positions.begin(), mesh.positions.end(),
                                  [](const Vec3& p) { return !p.allFinite(); });
  if (wrong != mesh.positions.end()) {
    return Error{ErrorCode::cannot_write,
                 "vertex " + std::to_string(wrong - mesh.positions.begin()) +
                     " of the mesh is not finite; check where it was computed"};
  }
  switch (format) {
  case MeshFormat::obj:
    return FormattedMesh{format_obj(mesh, attributes), lost_in(format, mesh, attributes)};
  case MeshFormat::off:
    return FormattedMesh{format_off(mesh, attributes), lost_in(format, mesh, attributes)};
  case MeshFormat::stl:
    return FormattedMesh{format_stl(mesh), lost_in(format, mesh, attributes)};
  case MeshFormat::ply:
    return FormattedMesh{PlyWriter(mesh, attributes, options.ascii_ply).write(),
                         lost_in(format, mesh, attributes)};
  case MeshFormat::gltf: {
    Result<std::string> bytes = format_gltf(mesh, attributes, options.gltf_json);
    return bytes ? Result<FormattedMesh>({std::move(*bytes), lost_in(format, mesh, attributes)})
                 : bytes.error();
  }
  }
  return Error{ErrorCode::unsupported, "no such format"}; // not reached
}

Result<std::string> format_mesh(const PolygonMesh& mesh, MeshFormat format,
                                const WriteOptions& options) {
  Result<FormattedMesh> formatted = format_mesh(mesh, MeshAttributes(), format, options);
  return formatted ? Result<std::string>(std::move(formatted->bytes)) : formatted.error();
}

Result<std::vector<FileNote>> write_mesh(const PolygonMesh& mesh, const MeshAttributes& attributes,
                                         const std::filesystem::path& path,
                                         const WriteOptions& options) {
  const std::string name = one_line(path.string());
  const std::optional<MeshFormat> format = format_of_name(path);
  if (!format) {
    return Error{ErrorCode::unsupported,
                 name +
                     ": the extension names no format that can be written; use .obj, .ply, .off, "
                     ".stl, .glb or .gltf"};
  }
  WriteOptions chosen = options;
  chosen.gltf_json = is_gltf_json_name(path);
  const Result<FormattedMesh> formatted = format_mesh(mesh, attributes, *format, chosen);
  if (!formatted) {
    return Error{formatted.error().code, name + ": " + formatted.error().message};
  }
  if (const Status written = write_file_atomically(path, formatted->bytes); !written) {
    return written.error();
  }
  std::vector<FileNote> notes;
  if (!formatted->lost.empty()) {
    std::string list;
    for (const std::string& what : formatted->lost) {
      list += (list.empty() ? "" : ", ") + what;
    }
    notes.push_back({"lost", name + ": " + std::string(name_of(*format)) +
                                 " cannot hold all: left out are " + list});
  }
  return notes;
}

Status write_mesh(const PolygonMesh& mesh, const std::filesystem::path& path,
                  const WriteOptions& options) {
  const Result<std::vector<FileNote>> written = write_mesh(mesh, MeshAttributes(), path, options);
  return written ? success() : written.error();
}

} // namespace cagewright
