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
};

/// Writes a mesh as OBJ, PLY, STL or OFF, by the extension.
///
/// Reading the file gives the same doubles: text holds the shortest digits that do, PLY is binary
/// (little endian) with double properties, and STL is text, because binary STL holds only floats.
/// What each format keeps besides positions and polygons:
///  - OBJ: colours without alpha; groups, as objects.
///  - PLY: colours.
///  - OFF: colours.
///  - STL: nothing; polygons are cut into triangles and vertices repeated for each.
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

/// The file's bytes alone. Errors: unsupported (glTF), cannot_write (a position is not finite).
Result<std::string> format_mesh(const PolygonMesh& mesh, MeshFormat format,
                                const WriteOptions& options = {});

} // namespace cagewright
