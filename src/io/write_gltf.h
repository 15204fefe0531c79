/// \file
/// A mesh as a new glTF file.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace cagewright {

/// Whether a glTF file of that name is JSON (.gltf) and not binary (.glb).
bool is_gltf_json_name(const std::filesystem::path& path);

/// The bytes of a GLB file: the JSON, and a binary chunk unless it is empty.
/// Errors: too_large (the lengths in a GLB file have 32 bits).
Result<std::string> glb_of(std::string_view json, std::string_view binary);

/// The mesh as GLB, or as JSON that holds its buffer. Each group becomes a node, under a node for
/// its object; faces are cut into triangles; a vertex is repeated for each set of texture point and
/// normal that its corners have. Positions are floats, from the middle of the model where it lies
/// so far from the origin that floats would lose digits: then the nodes move it there. Normals are
/// made unit; a corner without one, where others have one, gets that of its triangle.
///
/// Errors: cannot_write (a position beyond floats), too_large.
Result<std::string> format_gltf(const PolygonMesh& mesh, const MeshAttributes& attributes,
                                bool as_json);

} // namespace cagewright
