// Any bytes as a model file: the reader gives a mesh that keeps its promises or one line of error,
// and what it gives is cut into triangles, dressed, and written again in every format.
#include <cagewright/io/model_file.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

using namespace cagewright;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

bool is_one_line(const std::string& text) {
  return !text.empty() && text.find('\n') == text.npos;
}

void check(const PolygonMesh& mesh) {
  require(mesh.face_count() > 0);
  require(std::ranges::all_of(mesh.positions, [](const Vec3& p) { return p.allFinite(); }));
  require(std::ranges::all_of(mesh.corners(),
                              [&](Index corner) { return corner < mesh.positions.size(); }));
  require(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
  require(mesh.face_groups.empty() || mesh.face_groups.size() == mesh.face_count());
}

void check(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  const auto fits = [](std::size_t have, std::size_t want) { return have == 0 || have == want; };
  require(fits(attributes.texture_of_corner.size(), mesh.corners().size()));
  require(fits(attributes.normal_of_corner.size(), mesh.corners().size()));
  require(fits(attributes.face_materials.size(), mesh.face_count()));
  require(fits(attributes.face_colors.size(), mesh.face_count()));
  for (const MeshFormat format : {MeshFormat::obj, MeshFormat::ply, MeshFormat::off}) {
    const Result<FormattedMesh> written = format_mesh(mesh, attributes, format);
    require(written.has_value());
    const Result<ModelFile> again = ModelFile::parse(written->bytes, format, "again");
    require(again.has_value());
    require(again->mesh().positions.size() == mesh.positions.size());
    require(again->mesh().face_count() == mesh.face_count());
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const Result<ModelFile> file =
      ModelFile::parse(bytes, MeshFormat::CAGEWRIGHT_FUZZ_FORMAT, "file");
  if (!file) {
    require(is_one_line(file.error().message));
    return 0;
  }
  check(file->mesh());
  for (const FileNote& note : file->notes()) {
    require(is_one_line(note.message));
  }
  require(triangulate(file->mesh()).triangles.size() + 2 * file->mesh().face_count() ==
          file->mesh().corners().size());
  const Result<FileNormals> normals = file->normals();
  require(normals.has_value());
  const Result<MeshAttributes> attributes = file->attributes();
  require(attributes.has_value());
  check(file->mesh(), *attributes);
  return 0;
}
