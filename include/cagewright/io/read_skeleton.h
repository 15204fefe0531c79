/// \file
/// The joints of a rigged model.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace cagewright {

/// A joint of a skeleton.
struct Joint {
  static constexpr Index none = std::numeric_limits<Index>::max();

  std::string name;    ///< as in the file, or "node 7"
  Vec3 position;       ///< in the coordinates of read_mesh() for the same pose
  Index parent = none; ///< the nearest joint above it, an index into Skeleton::joints, or `none`
};

/// The joints that the meshes of a model follow, each once, parents before their children.
struct Skeleton {
  std::vector<Joint> joints; ///< none where the model is not rigged
};

/// Reads the joints of the skins that the default scene of a glTF file shows. In the pose `bind` a
/// joint stands where the first skin that names it was bound to it; where that skin says nothing
/// of it, and in the pose `shown`, where its node stands. Other formats have no joints.
///
/// Errors: those of read_mesh(). Cost: that of opening the file; the mesh is not read.
Result<Skeleton> read_skeleton(const std::filesystem::path& path, Pose pose = Pose::shown);

} // namespace cagewright
