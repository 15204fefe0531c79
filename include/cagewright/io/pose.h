/// \file
/// In which pose a rigged model is read.
#pragma once

namespace cagewright {

/// Only glTF files have poses; of other files both are the same.
enum class Pose {
  /// As any viewer shows the file: skinned meshes where their joints put them (glTF 2.0, 3.7.3.3),
  /// with the default weights of the morph targets.
  shown,
  /// As the meshes are stored: skinned ones where they were bound to their joints, that is, without
  /// any transform; the others under their nodes; without morph targets.
  bind,
};

} // namespace cagewright
