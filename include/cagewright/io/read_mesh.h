/// \file
/// Meshes from files.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/pose.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <string_view>

namespace cagewright {

/// Reads a mesh from an OBJ, PLY, STL, OFF, GLB or glTF file.
///
/// The content decides when it shows its format (a PLY file named .obj is read as PLY), else the
/// extension. Vertices and faces keep the order of the file: no vertices are merged, so an STL file
/// has three for each facet. Faces of one or two corners are left out, and a corner named twice in
/// a row is taken once (docs/formats.md); ModelFile tells. Text is rounded correctly to double.
/// What each format gives:
///  - OBJ: polygons, colours after the position, objects and groups; lines and points are skipped.
///  - PLY: polygons and triangle strips, vertex colours; other elements and properties are skipped.
///  - STL: facets; several solids make one mesh.
///  - OFF: polygons and the colours of COFF; faces of one or two corners are points and lines to
///    OFF, and skipped as such.
///  - glTF: the triangles of the default scene in its coordinates, each mesh once for every node
///    that shows it, as groups. Rigged meshes and morph targets are as `pose` says.
///
/// The mesh has at least one face, every position is finite and every corner is a vertex. Colours
/// are scaled to [0, 1]; where only some vertices have one, the others are white.
///
/// Errors: cannot_open, malformed, unsupported, too_large. The message is one line with the file,
/// the line or byte where there is one, what is wrong and what helps.
/// Cost: one read and one pass; memory for the file (at most 4 GiB) and the mesh.
Result<PolygonMesh> read_mesh(const std::filesystem::path& path, Pose pose = Pose::shown);

/// The same for a file in memory. `name` stands for the file in messages. A glTF file cannot refer
/// to others here: unsupported.
Result<PolygonMesh> read_mesh(std::string_view bytes, MeshFormat format, std::string_view name,
                              Pose pose = Pose::shown);

} // namespace cagewright
