#include "load.h"

#include "session.h"

#include "io/atomic_file.h"
#include "io/linked_files.h"
#include "io/source.h"
#include <cagewright/io/mesh_format.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;

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
      const char* kind = note.code == "lost" ? "warning" : "note";
      std::fprintf(stderr, "cagewright: %s: %s\n", kind, note.message.c_str());
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
    error.message = one_line(path) + ": " + error.message;
  }
  return error;
}

Status can_write_output(const std::string& path, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code none; // a file that is not there yet is no input
    if (fs::equivalent(path, input, none) && fs::is_regular_file(path, none)) {
      return Error{ErrorCode::cannot_write,
                   one_line(path) + ": the command reads this file and would write over it; give "
                                    "the output another name"};
    }
  }
  return path == "-" ? success() : can_write_file(path);
}

Status can_write_model(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code none;
  if (!fs::is_directory(path, none) && !format_of_name(path)) {
    return Error{ErrorCode::unsupported,
                 one_line(path) + ": models are written as .obj, .ply, .stl, .off, .glb or .gltf; "
                                  "use one of these"};
  }
  return can_write_output(path, inputs);
}

Status can_write_cage(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code none;
  if (!fs::is_directory(path, none) && format_of_name(path) == MeshFormat::gltf) {
    return Error{ErrorCode::unsupported,
                 one_line(path) + ": cages are written as .obj, .ply, .stl or .off; glTF holds "
                                  "only triangles, in single precision ('cagewright convert' "
                                  "makes it of the cage)"};
  }
  if (!fs::is_directory(path, none) && !format_of_name(path)) {
    return Error{ErrorCode::unsupported,
                 one_line(path) + ": cages are written as .obj, .ply, .stl or .off; use one of "
                                  "these"};
  }
  return can_write_output(path, inputs);
}

void warn_of_links(const ModelFile& model, const std::string& written) {
  const fs::path folder = fs::path(written).parent_path();
  for (const fs::path& link : linked_files(model.path())) {
    if (!fs::exists(folder / link)) {
      warn(fmt::format("{} refers to {}, which is not beside it; copy it from {}",
                       one_line(written), one_line(link.string()),
                       one_line(fs::absolute(model.path()).parent_path().string())));
    }
  }
}

} // namespace cagewright::cli
