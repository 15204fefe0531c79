// Any bytes as a model file: the reader gives a mesh that keeps its promises or one line of error,
// and what it gives is cut into triangles, dressed, written again in every format, and moved.
#include "require.h"

#include <cagewright/io/model_file.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/every_cutting.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

using namespace cagewright;
using fuzz::require;
using fuzz::require_one_line;

constexpr MeshFormat format_at_hand = MeshFormat::CAGEWRIGHT_FUZZ_FORMAT;

void check(const PolygonMesh& mesh) {
  require(mesh.face_count() > 0, "a mesh has faces");
  require(std::ranges::all_of(mesh.positions, [](const Vec3& p) { return p.allFinite(); }),
          "positions are finite");
  require(std::ranges::all_of(mesh.corners(),
                              [&](Index corner) { return corner < mesh.positions.size(); }),
          "corners are vertices");
  require(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size(), "a color a vertex");
  require(mesh.face_groups.empty() || mesh.face_groups.size() == mesh.face_count(),
          "a group a face");
  const Triangulation triangles = triangulate(mesh);
  require(triangles.triangles.size() + 2 * mesh.face_count() == mesh.corners().size(),
          "a face of n corners has n - 2 triangles");
  require(every_cutting(mesh).triangles.size() >= triangles.triangles.size(), "all cuttings");
}

void check_written(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  const std::size_t triangles = triangulate(mesh).triangles.size();
  for (const MeshFormat format :
       {MeshFormat::obj, MeshFormat::ply, MeshFormat::off, MeshFormat::stl, MeshFormat::gltf}) {
    const Result<FormattedMesh> written = format_mesh(mesh, attributes, format);
    if (!written) { // only coordinates beyond the range of floats are refused
      require_one_line(written.error().message);
      require(format == MeshFormat::gltf, "each format but glTF takes any finite mesh");
      continue;
    }
    const Result<ModelFile> again = ModelFile::parse(written->bytes, format, "again");
    require(again.has_value(), "what is written can be read");
    const bool has_triangles = format == MeshFormat::stl || format == MeshFormat::gltf;
    require(again->mesh().face_count() == (has_triangles ? triangles : mesh.face_count()),
            "all faces are written");
    require(has_triangles || again->mesh().positions == mesh.positions,
            "positions read back as the same numbers");
  }
}

void check(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  const auto fits = [](std::size_t have, std::size_t want) { return have == 0 || have == want; };
  require(fits(attributes.texture_of_corner.size(), mesh.corners().size()), "texture of corners");
  require(fits(attributes.normal_of_corner.size(), mesh.corners().size()), "normals of corners");
  require(fits(attributes.face_materials.size(), mesh.face_count()), "materials of faces");
  require(fits(attributes.face_colors.size(), mesh.face_count()), "colors of faces");
  check_written(mesh, attributes);
}

/// A file that is this process's alone, named for its format.
std::filesystem::path moved_file(const ModelFile& file, bool is_glb) {
  constexpr std::string_view formats[] = {".obj", ".ply", ".stl", ".off", ".gltf"};
  const auto at = static_cast<std::size_t>(file.format());
  return std::filesystem::temp_directory_path() / ("cagewright-fuzz-" + std::to_string(::getpid()) +
                                                   std::string(is_glb ? ".glb" : formats[at]));
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool is_near(double a, double b) {
  return std::abs(a - b) <= 1e-6 * std::abs(b) + 1e-30; // files of floats
}

void check_moved(const ModelFile& file, const FileNormals& normals, bool is_glb) {
  std::vector<Vec3> positions = file.mesh().positions;
  for (Vec3& p : positions) {
    p = p / 2 + Vec3(1, 2, 3);
  }
  const std::filesystem::path path = moved_file(file, is_glb);
  const Status written = file.rewrite(positions, normals.normals, path);
  if (!written) {
    require_one_line(written.error().message);
    return;
  }
  // (By its content alone a file may be of another format than the one tried here.)
  const Result<ModelFile> moved = file.format() == MeshFormat::gltf
                                      ? ModelFile::open(path, file.pose())
                                      : ModelFile::parse(bytes_of(path), file.format(), "moved");
  std::filesystem::remove(path);
  std::filesystem::remove(std::filesystem::path(path).replace_extension(".bin"));
  require(moved.has_value(), "a moved model can be read");
  require(moved->format() == format_at_hand, "a moved model has its format");
  require(moved->mesh().positions.size() == positions.size(), "a moved model has its vertices");
  require(std::ranges::equal(moved->mesh().corners(), file.mesh().corners()),
          "a moved model has its faces");
  for (std::size_t v = 0; v < positions.size() && format_at_hand != MeshFormat::gltf; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      require(is_near(moved->mesh().positions[v][axis], positions[v][axis]), "vertices have moved");
    }
  }
}

void check_pose(const std::string& bytes, Pose pose) {
  const Result<ModelFile> file = ModelFile::parse(bytes, format_at_hand, "file", pose);
  if (!file) {
    require_one_line(file.error().message);
    return;
  }
  check(file->mesh());
  for (const FileNote& note : file->notes()) {
    require_one_line(note.message);
  }
  const Result<FileNormals> normals = file->normals();
  require(normals.has_value(), "a mesh that can be read has normals that can");
  const Result<MeshAttributes> attributes = file->attributes();
  require(attributes.has_value(), "a mesh that can be read has attributes that can");
  check(file->mesh(), *attributes);
  check_moved(*file, *normals, bytes.starts_with("glTF"));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  check_pose(bytes, Pose::shown);
  if (format_at_hand == MeshFormat::gltf) {
    check_pose(bytes, Pose::bind);
  }
  return 0;
}
