/// \file
/// The plane in which a model is its own mirror image, or nearly so.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/symmetry/mirror_pairing.h>

#include <optional>

namespace cagewright {

struct MirrorOptions {
  /// No plane is found if the best one's errors are above these. A model that is lifted off its
  /// mirror image by the mean error has a cage looser by about half of that.
  double most_mean_error = 0.003;
  double most_high_error = 0.03;
  Vec3 origin = Vec3::Zero(); ///< planes through it are preferred if they do as well
};

/// The plane in which the model's surface is most nearly its own mirror image, if it is nearly
/// enough.
///
/// Planes are tried through the middle of the surface: across its principal axes, the world's axes,
/// and some 200 directions besides; the best are refined by matching the mirror image of points of
/// the surface with the nearest points of the surface. A plane across one of the world's axes,
/// through that origin or the middle of the model's box, is taken instead if it does as well. Of
/// several planes that do as well as each other (those of a box) one across x is preferred, then y,
/// then z; one along which the model is thin comes last.
///
/// The surface is judged by area, not by vertices: it does not matter how it is cut into triangles,
/// or whether they are consistently oriented.
///
/// None for a model without area. Cost: some 100,000 queries of nearest points.
std::optional<MirrorPlane> detect_mirror_plane(TriangleView model,
                                               const MirrorOptions& options = {},
                                               const Progress& progress = {});

/// The best plane across the world's axis 0, 1 or 2, however good. None for a model without area,
/// or if it is to stop. \param origin  a plane through it is preferred if it does as well
std::optional<MirrorPlane> best_mirror_plane(TriangleView model, int axis,
                                             const Vec3& origin = Vec3::Zero(),
                                             const Progress& progress = {});

} // namespace cagewright
