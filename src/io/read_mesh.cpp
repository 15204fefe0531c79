#include <cagewright/io/read_mesh.h>

#include "io/read_file.h"
#include "io/readers.h"
#include "io/source.h"

#include <algorithm>
#include <new>
#include <optional>
#include <string>

namespace cagewright {
namespace {

// What people have at hand besides meshes, by the first bytes.
struct Foreign {
  std::string_view begin;
  std::string_view name;
  std::string_view remedy;
};
constexpr Foreign foreign_files[] = {
    {"\x1f\x8b", "a gzip archive", "unpack it first"},
    {"PK\x03\x04", "a zip archive", "unpack it first"},
    {"Kaydara FBX", "an FBX file", "export the model as OBJ or GLB"},
    {"; FBX", "an FBX file", "export the model as OBJ or GLB"},
    {"BLENDER", "a Blender file", "export the model as OBJ or GLB"},
    {"<?xml", "an XML file", "export the model as OBJ or GLB"},
    {"\xff\xfe", "a text in UTF-16", "save it as UTF-8"},
    {"\xfe\xff", "a text in UTF-16", "save it as UTF-8"},
};

std::optional<Error> foreign_file(const Source& source) {
  for (const Foreign& kind : foreign_files) {
    if (source.bytes.starts_with(kind.begin)) {
      return source.error("is " + std::string(kind.name) + "; " + std::string(kind.remedy),
                          ErrorCode::unsupported);
    }
  }
  return std::nullopt;
}

Error is_empty(const Source& source) {
  return source.error("the file is empty" + std::string(export_again));
}

Error unknown_format(const Source& source) {
  return source.error("is no mesh in a known format; use OBJ, PLY, STL, OFF, GLB or glTF",
                      ErrorCode::unsupported);
}

Result<PolygonMesh> read_as(MeshFormat format, const Source& source,
                            const std::optional<std::filesystem::path>& folder) {
  if (source.bytes.empty()) {
    return is_empty(source);
  }
  try {
    switch (format) {
    case MeshFormat::obj:
      return read_obj(source);
    case MeshFormat::off:
      return read_off(source);
    case MeshFormat::ply:
      return read_ply(source);
    case MeshFormat::stl:
      return read_stl(source);
    case MeshFormat::gltf:
      return read_gltf(source, folder);
    }
  } catch (const std::bad_alloc&) {
    return source.error("there is not enough memory for the mesh; simplify the model",
                        ErrorCode::too_large);
  }
  return unknown_format(source); // only for a value outside the enumeration
}

} // namespace

void normalize_colors(PolygonMesh& mesh) {
  float largest = 0;
  for (const auto& color : mesh.colors) {
    for (const float channel : color) {
      largest = channel == full_channel ? largest : std::max(largest, channel); // nan: passed by
    }
  }
  const float unit = largest > 1 ? 255.0F : 1.0F;
  for (auto& color : mesh.colors) {
    for (float& channel : color) {
      channel = channel > 0 ? std::min(channel / unit, 1.0F) : 0.0F; // nan becomes 0
    }
  }
}

Result<PolygonMesh> read_mesh(std::string_view bytes, MeshFormat format, std::string_view name) {
  return read_as(format, Source{name, bytes}, {});
}

Result<PolygonMesh> read_mesh(const std::filesystem::path& path) {
  const Result<FileBytes> file = read_file(path);
  if (!file) {
    return file.error();
  }
  const std::string name = path.string();
  const Source source{name, file->view()};
  if (source.bytes.empty()) {
    return is_empty(source);
  }
  std::optional<MeshFormat> format = format_of_content(source.bytes);
  if (!format) {
    if (const std::optional<Error> error = foreign_file(source)) {
      return *error;
    }
    format = format_of_name(path);
  }
  return format ? read_as(*format, source, path.parent_path()) : unknown_format(source);
}

} // namespace cagewright
