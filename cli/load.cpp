#include "load.h"

#include <cagewright/io/mesh_format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

// One run of the program is one command, which reads from one thread.
std::vector<FileNote>& told() {
  static std::vector<FileNote> notes;
  return notes;
}

} // namespace

void tell(std::span<const FileNote> notes) {
  for (const FileNote& note : notes) {
    const bool is_new = std::ranges::none_of(
        told(), [&](const FileNote& other) { return other.message == note.message; });
    if (is_new) {
      std::fprintf(stderr, "cagewright: note: %s\n", note.message.c_str());
      told().push_back(note);
    }
  }
}

nlohmann::json notes_as_json() {
  nlohmann::json list = nlohmann::json::array();
  for (const FileNote& note : told()) {
    list.push_back({{"code", note.code}, {"message", note.message}});
  }
  return list;
}

Result<ModelFile> load_model(const std::string& path, Pose pose) {
  Result<ModelFile> file = ModelFile::open(path, pose);
  if (file) {
    tell(file->notes());
  }
  return file;
}

Result<PolygonMesh> load_mesh(const std::string& path, Pose pose) {
  Result<ModelFile> file = load_model(path, pose);
  return file ? Result<PolygonMesh>(std::move(*file).take_mesh()) : file.error();
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
