#include <cagewright/io/write_mesh.h>

#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/source.h"
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

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

std::string format_obj(const PolygonMesh& mesh) {
  Text text(expected_size(mesh));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    text << "v " << mesh.positions[v];
    if (!mesh.colors.empty()) {
      for (int channel = 0; channel < 3; ++channel) {
        (text << ' ').number(mesh.colors[v][channel]);
      }
    }
    text << '\n';
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!mesh.face_groups.empty() && (f == 0 || mesh.face_groups[f] != mesh.face_groups[f - 1])) {
      text << "o " << label(mesh.group_names[mesh.face_groups[f]]) << '\n';
    }
    text << 'f';
    for (const Index corner : mesh.face(f)) {
      (text << ' ').number(std::uint64_t{corner} + 1);
    }
    text << '\n';
  }
  return std::move(text).take();
}

std::string format_off(const PolygonMesh& mesh) {
  Text text(expected_size(mesh));
  text << (mesh.colors.empty() ? "OFF\n" : "COFF\n");
  text.number(mesh.positions.size()) << ' ';
  text.number(mesh.face_count()) << " 0\n";
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    text << mesh.positions[v];
    if (!mesh.colors.empty()) {
      for (const float channel : mesh.colors[v]) {
        (text << ' ').number(channel);
      }
    }
    text << '\n';
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    text.number(mesh.face(f).size());
    for (const Index corner : mesh.face(f)) {
      (text << ' ').number(corner);
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

PlyTypes ply_types(const PolygonMesh& mesh) {
  PlyTypes types{true, false, mesh.positions.size() <= std::size_t{1} << 31U};
  for (const auto& color : mesh.colors) {
    types.byte_colors &= std::all_of(color.begin(), color.end(), [](float channel) {
      return std::round(channel * 255) / 255 == channel;
    });
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    types.wide_counts |= mesh.face(f).size() > 255;
  }
  return types;
}

void append_ply_header(Text& text, const PolygonMesh& mesh, const PlyTypes& types, bool ascii) {
  text << "ply\nformat " << (ascii ? "ascii" : "binary_little_endian") << " 1.0\nelement vertex ";
  text.number(mesh.positions.size());
  text << "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!mesh.colors.empty()) {
    for (const char* channel : {"red", "green", "blue", "alpha"}) {
      text << "property " << (types.byte_colors ? "uchar " : "float ") << channel << '\n';
    }
  }
  text << "element face ";
  text.number(mesh.face_count());
  text << "\nproperty list " << (types.wide_counts ? "uint" : "uchar")
       << (types.signed_indices ? " int" : " uint") << " vertex_indices\nend_header\n";
}

std::uint8_t to_byte(float channel) {
  return static_cast<std::uint8_t>(std::lround(channel * 255));
}

void append_ply_text(Text& text, const PolygonMesh& mesh, const PlyTypes& types) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    text << mesh.positions[v];
    if (!mesh.colors.empty()) {
      for (const float channel : mesh.colors[v]) {
        text << ' ';
        types.byte_colors ? text.number(to_byte(channel)) : text.number(channel);
      }
    }
    text << '\n';
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    text.number(mesh.face(f).size());
    for (const Index corner : mesh.face(f)) {
      (text << ' ').number(corner);
    }
    text << '\n';
  }
}

void append_ply_binary(Text& text, const PolygonMesh& mesh, const PlyTypes& types) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (const double coordinate : mesh.positions[v]) {
      text.binary(coordinate);
    }
    if (!mesh.colors.empty()) {
      for (const float channel : mesh.colors[v]) {
        types.byte_colors ? text.binary(to_byte(channel)) : text.binary(channel);
      }
    }
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::size_t count = mesh.face(f).size();
    types.wide_counts ? text.binary(static_cast<std::uint32_t>(count))
                      : text.binary(static_cast<std::uint8_t>(count));
    for (const Index corner : mesh.face(f)) {
      text.binary(corner);
    }
  }
}

std::string format_ply(const PolygonMesh& mesh, bool ascii) {
  Text text(expected_size(mesh));
  const PlyTypes types = ply_types(mesh);
  append_ply_header(text, mesh, types, ascii);
  ascii ? append_ply_text(text, mesh, types) : append_ply_binary(text, mesh, types);
  return std::move(text).take();
}

} // namespace

Result<std::string> format_mesh(const PolygonMesh& mesh, MeshFormat format,
                                const WriteOptions& options) {
  const auto wrong = std::find_if(mesh.positions.begin(), mesh.positions.end(),
                                  [](const Vec3& p) { return !p.allFinite(); });
  if (wrong != mesh.positions.end()) {
    return Error{ErrorCode::cannot_write,
                 "vertex " + std::to_string(wrong - mesh.positions.begin()) +
                     " of the mesh is not finite; check where it was computed"};
  }
  switch (format) {
  case MeshFormat::obj:
    return format_obj(mesh);
  case MeshFormat::off:
    return format_off(mesh);
  case MeshFormat::stl:
    return format_stl(mesh);
  case MeshFormat::ply:
    return format_ply(mesh, options.ascii_ply);
  case MeshFormat::gltf:
    break;
  }
  return Error{ErrorCode::unsupported, "glTF cannot be written; use .obj, .ply, .off or .stl"};
}

Status write_mesh(const PolygonMesh& mesh, const std::filesystem::path& path,
                  const WriteOptions& options) {
  const std::string name = one_line(path.string());
  const std::optional<MeshFormat> format = format_of_name(path);
  if (!format) {
    return Error{ErrorCode::unsupported,
                 name + ": the extension names no format that can be written; use .obj, .ply, .off "
                        "or .stl"};
  }
  const Result<std::string> bytes = format_mesh(mesh, *format, options);
  if (!bytes) {
    return Error{bytes.error().code, name + ": " + bytes.error().message};
  }
  return write_file_atomically(path, *bytes);
}

} // namespace cagewright
