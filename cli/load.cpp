#include "load.h"

#include <cagewright/io/mesh_format.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace cagewright::cli {

Result<TriangleMesh> load_triangles(const std::string& path) {
  const Result<PolygonMesh> mesh = read_mesh(path);
  if (!mesh) {
    return mesh.error();
  }
  return to_triangle_mesh(*mesh);
}

Error in_file(const std::string& path, Error error) {
  if (error.code != ErrorCode::cancelled) {
    error.message = path + ": " + error.message;
  }
  return error;
}

Status can_write_mesh(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    return Error{ErrorCode::cannot_write, path + ": is a folder; give the name of a file"};
  }
  const std::optional<MeshFormat> format = format_of_name(path);
  if (!format || *format == MeshFormat::gltf) {
    return Error{ErrorCode::unsupported,
                 path + ": meshes are written as .obj, .ply, .stl or .off; use one of these"};
  }
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) {
    folder = ".";
  }
  if (!fs::is_directory(folder, ignored)) {
    return Error{ErrorCode::cannot_write,
                 path + ": the folder " + folder.string() + " does not exist; create it first"};
  }
  if (access(folder.c_str(), W_OK) != 0) {
    return Error{ErrorCode::cannot_write,
                 path + ": no permission to write to the folder " + folder.string()};
  }
  return success();
}

} // namespace cagewright::cli
