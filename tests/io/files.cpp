#include "io/files.h"

#include <cagewright/io/read_mesh.h>

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>

namespace cagewright::test {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "cagewright-XXXXXX").string();
  path_ = ::mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::add(std::string_view name, std::string_view bytes) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string make_glb(std::string json, std::string chunk) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
  const auto size = static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + chunk.size());
  return "glTF" + binary(std::uint32_t{2}, size, static_cast<std::uint32_t>(json.size())) + "JSON" +
         json + binary(static_cast<std::uint32_t>(chunk.size())) + std::string("BIN\0", 4) + chunk;
}

std::vector<Sample> samples() {
  // A tetrahedron over the origin and the three unit points.
  const std::string text_points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string text_faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string points = binary(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F);
  std::string list_faces;
  std::string index_faces;
  std::string facets;
  for (const auto& f : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    list_faces += '\3' + binary(f[0], f[1], f[2]);
    facets += binary(0.F, 0.F, 0.F);
    for (const int corner : f) {
      index_faces += binary(static_cast<std::uint16_t>(corner));
      facets += points.substr(12 * static_cast<std::size_t>(corner), 12);
    }
    facets += binary(std::uint16_t{0});
  }
  const std::string ply_header = "element vertex 4\nproperty float x\nproperty float y\nproperty "
                                 "float z\nelement face 4\nproperty list uchar int "
                                 "vertex_indices\nend_header\n";
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0,"children":[1]},{"scale":[2,2,2],"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":48},)"
      R"({"buffer":0,"byteOffset":48,"byteLength":24}],)"
      R"("buffers":[{"byteLength":72)";
  const std::string base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
                             "AAACAAEAAAABAAMAAAADAAIAAQACAAMA";
  return {
      {"obj", MeshFormat::obj,
       "# a tetrahedron\no part\nv 0 0 0\nv 1 0 0 1 0.5 0\nv 0 1 0\nv 0 0 1e0\nvt 0 0\nvn 0 0 1\n"
       "f 1 3/1 2//1\nf 1/1/1 2 4\nf -4 -1 \\\n-2\nf 2 3 4\n"},
      {"off", MeshFormat::off, "OFF\n# a tetrahedron\n4 4 6\n" + text_points + text_faces},
      {"binary off", MeshFormat::off,
       // Big endian: 3 vertices and 1 face without a colour.
       "OFF BINARY\n" + std::string("\0\0\0\3\0\0\0\1\0\0\0\0", 12) + std::string(12, '\0') +
           std::string("\x3f\x80\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0\0\0\0\0", 24) +
           std::string("\0\0\0\3\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\0", 20)},
      {"text ply", MeshFormat::ply,
       "ply\nformat ascii 1.0\n" + ply_header + text_points + text_faces},
      {"binary ply", MeshFormat::ply,
       "ply\nformat binary_little_endian 1.0\n" + ply_header + points + list_faces},
      {"text stl", MeshFormat::stl,
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
       "endloop\nendfacet\nendsolid a\n"},
      {"binary stl", MeshFormat::stl, std::string(80, ' ') + binary(std::uint32_t{4}) + facets},
      {"glb", MeshFormat::gltf, make_glb(gltf + "}]}", points + index_faces)},
      {"gltf", MeshFormat::gltf,
       gltf + R"(,"uri":"data:application/octet-stream;base64,)" + base64 + "\"}]}"},
  };
}

Result<PolygonMesh> read(std::string_view bytes, MeshFormat format) {
  return read_mesh(bytes, format, "file");
}

std::string message_of(std::string_view bytes, MeshFormat format) {
  const Result<PolygonMesh> mesh = read(bytes, format);
  return mesh ? "read" : mesh.error().message;
}

std::vector<std::vector<Index>> faces_of(const PolygonMesh& mesh) {
  std::vector<std::vector<Index>> faces;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
  }
  return faces;
}

} // namespace cagewright::test
