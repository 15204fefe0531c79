/// \file
/// Whether a cage is to be its own mirror image, and in which plane. Internal to this module.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/symmetry/mirror_pairing.h>

#include <optional>
#include <string>

namespace cagewright {

/// The plane that a cage is to be mirrored in; none if it is not to be mirrored.
struct Mirroring {
  std::optional<MirrorPlane> plane;
  /// Rather no cage than one that is not mirrored in that plane.
  bool is_insisted_on = false;
  /// Why there is no plane, unless that is what was asked for.
  std::string why_not;
  /// Faces and vertices are to be paired, as positions cannot be: see paired_surface().
  bool by_topology = false;
};

/// As the options say.
///
/// \param origin  of the user's coordinates: planes through it are preferred if they do as well
/// Cost: that of detect_mirror_plane().
Mirroring choose_mirroring(TriangleView model, const GenerateOptions& options, const Vec3& origin,
                           const Progress& progress = {});

} // namespace cagewright
