/// \file
/// A cage that follows the rig of its model.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <string>

namespace cagewright {

/// A glTF file with the rig of a model (nodes, joints, animations) and the cage as its only mesh,
/// skinned: each vertex follows the joints that the vertices of the model near it follow, nearer
/// ones more, at most four. So whatever moves the model in the file moves the cage.
///
/// The file, read in the same pose, has the cage where it is given, to float precision. In the pose
/// `shown` it is bound to the joints as they stand in the file, in the pose `bind` as the model's
/// own skins say. Parts of the model without a skin carry the cage by their nodes.
///
/// \param model    a glTF or GLB file with a skin
/// \param cage     C vertices, in the coordinates of read_mesh() for this pose
/// \param as_json  .gltf that holds its buffer, else .glb
/// \returns the bytes of the file
/// Errors: those of read_mesh(); unsupported (the model has no joints, or they flatten all that
/// follows them), too_large.
/// Cost: O(V C) for a model of V vertices.
Result<std::string> format_skinned_cage(const std::filesystem::path& model, Pose pose,
                                        const PolygonMesh& cage, bool as_json);

} // namespace cagewright
