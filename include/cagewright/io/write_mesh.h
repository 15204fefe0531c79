/// \file
/// Meshes to files.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/model_file.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cagewright {

struct WriteOptions {
  bool ascii_ply = false; ///< PLY as text instead of binary
  bool gltf_json = false; ///< glTF as JSON instead of GLB; of a file the extension decides
};

/// Writes a mesh as OBJ, PLY, STL, OFF or glTF (.glb or .gltf), by the extension.
///
/// Reading the file gives the same doubles: text holds the shortest digits that do, PLY is binary
/// (little endian) with double properties, and STL is text, because binary STL holds only floats.
/// glTF alone has floats, within a millionth of the model's size.
/// What each format keeps besides positions and polygons:
///  - OBJ: colours without alpha; groups, as objects.
///  - PLY: colours.
///  - OFF: colours.
///  - STL: nothing; polygons are cut into triangles and vertices repeated for each.
///  - glTF: colours, groups as nodes; polygons are cut into triangles.
/// The file appears under its name only when complete (see write_file_atomically()).
///
/// Errors: unsupported (another extension), cannot_write; also cannot_write for a position that is
/// not finite, which no reader would take.
Status write_mesh(const PolygonMesh& mesh, const std::filesystem::path& path,
                  const WriteOptions& options = {});

/// Writes a mesh with what else its file held, as far as the format can:
///  - OBJ: texture points, normals, materials, objects and groups, comments.
///  - PLY: texture points and normals where each vertex has one; texture points of corners as the
///    list `texcoord` of faces; face colours; values of vertices and faces; comments.
///  - OFF: texture points and normals where each vertex has one; face colours.
///  - glTF: texture points, normals, objects, names of materials; vertices are repeated where their
///    corners differ.
/// \returns a note (code "lost") that names what the format cannot hold, or nothing
/// Errors: as above.
Result<std::vector<FileNote>> write_mesh(const PolygonMesh& mesh, const MeshAttributes& attributes,
                                         const std::filesystem::path& path,
                                         const WriteOptions& options = {});

/// The bytes of such a file, and in words what it cannot hold.
struct FormattedMesh {
  std::string bytes;
  std::vector<std::string> lost; ///< "texture coordinates", "materials"
};
Result<FormattedMesh> format_mesh(const PolygonMesh& mesh, const MeshAttributes& attributes,
                                  MeshFormat format, const WriteOptions& options = {});

/// The file's bytes alone. Errors: cannot_write (a position is not finite, or in glTF too large).
Result<std::string> format_mesh(const PolygonMesh& mesh, MeshFormat format,
                                const WriteOptions& options = {});

} // namespace cagewright
