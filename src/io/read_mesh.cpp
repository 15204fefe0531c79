#include <cagewright/io/model_file.h>
#include <cagewright/io/read_mesh.h>

#include "io/readers.h"
#include "io/source.h"
#include "mesh/reach.h"

#include <algorithm>
#include <new>
#include <optional>
#include <string>

namespace cagewright {
namespace {

Error is_empty(const Source& source) {
  return source.error("the file is empty" + std::string(export_again));
}

/// What a reader made, unless a vertex is so far away that nothing can be said of the mesh.
Result<PolygonMesh> within_reach(Result<PolygonMesh> mesh, const Source& source) {
  if (!mesh) {
    return mesh;
  }
  const auto far =
      std::find_if_not(mesh->positions.begin(), mesh->positions.end(), is_within_reach);
  if (far == mesh->positions.end()) {
    return mesh;
  }
  return source.error("vertex " + std::to_string(far - mesh->positions.begin()) +
                      ", counted from 0, has a coordinate beyond 1e100, with which nothing can be "
                      "measured; mend the vertex, or scale the model down");
}

Result<PolygonMesh> read_by(MeshFormat format, const Source& source,
                            const std::optional<std::filesystem::path>& folder, Reading& reading) {
  switch (format) {
  case MeshFormat::obj:
    return read_obj(source, reading);
  case MeshFormat::off:
    return read_off(source, reading);
  case MeshFormat::ply:
    return read_ply(source, reading);
  case MeshFormat::stl:
    return read_stl(source, reading);
  case MeshFormat::gltf:
    return read_gltf(source, folder, reading);
  }
  return unknown_format(source); // only for a value outside the enumeration
}

} // namespace

Error unknown_format(const Source& source) {
  return source.error("is no mesh in a known format; use OBJ, PLY, STL, OFF, GLB or glTF",
                      ErrorCode::unsupported);
}

Result<PolygonMesh> read_as(MeshFormat format, const Source& source,
                            const std::optional<std::filesystem::path>& folder, Reading& reading) {
  if (source.bytes.empty()) {
    return is_empty(source);
  }
  try {
    return within_reach(read_by(format, source, folder, reading), source);
  } catch (const std::bad_alloc&) {
    return source.error("there is not enough memory for the mesh; simplify the model",
                        ErrorCode::too_large);
  }
}

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

Result<PolygonMesh> read_mesh(std::string_view bytes, MeshFormat format, std::string_view name,
                              Pose pose) {
  Reading reading;
  reading.pose = pose;
  return read_as(format, Source{name, bytes}, {}, reading);
}

Result<PolygonMesh> read_mesh(const std::filesystem::path& path, Pose pose) {
  Result<ModelFile> file = ModelFile::open(path, pose);
  return file ? Result<PolygonMesh>(std::move(*file).take_mesh()) : file.error();
}

} // namespace cagewright
