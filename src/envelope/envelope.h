/// \file
/// A surface of voxels round a model: where the improvement starts when there are no boxes.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <optional>

namespace cagewright {

struct EnvelopeOptions {
  /// Voxels along the model's diagonal. 0: chosen so that the envelope has no handles that come
  /// and go with the resolution, and is no finer than `vertices` warrants. If the model has more
  /// handles than that many vertices can go round, the narrowest are then filled.
  int resolution = 0;
  int vertices = 100; ///< of the cage that is to be made of it: guides the choice of resolution
  double clearance = 0.002; ///< least distance to the model, in diagonals of its bounding box
  /// Holes and gaps narrower than twice this, in diagonals, are filled.
  double closing = 0;
  /// Handles that the model does not have itself, and those that so few vertices cannot go round,
  /// are filled with thin skins if a ball of this diameter, in diagonals, cannot get through. 0:
  /// none are.
  double fill = 0;
  /// The handles that the model has itself. Below 0: known_handles(), or 0.
  int own_handles = -1;
  /// Make the envelope of the model and its mirror image in the plane x = 0, and return the half of
  /// it at x >= 0: open, the boundary on the plane exactly, no face in it, and no edge of two faces
  /// between two vertices of the plane.
  bool half = false;
  /// What lengths are fractions of. 0: the diagonal of the model's box.
  double diagonal = 0;
};

/// A closed surface round a model, and what is known about it.
struct Envelope {
  TriangleMesh mesh;
  int resolution = 0; ///< voxels along the model's diagonal
  double closing = 0; ///< that was needed: see EnvelopeOptions
  double fill = 0;    ///< the same
  int genus = 0;      ///< handles of the whole surface
  int known = 0;      ///< handles of the model itself, if it is one closed piece
  int bridges = 0;    ///< rods of voxels added to join the model's pieces
};

/// The handles of a model of one closed piece, which no grid is likely to show fewer of. Of other
/// models nothing is known.
std::optional<int> known_handles(TriangleView model);

/// The outer boundary of the voxels that come within the clearance of the model or lie inside it:
/// one closed, manifold surface, oriented outward, that keeps the clearance everywhere and encloses
/// every vertex and every triangle of the model. Pieces of the model that lie apart are joined by
/// rods of voxels; cavities are filled.
///
/// Errors: unfit_model, invalid_option, too_large, cancelled.
/// Cost: that of voxelize(), a few times if the resolution is to be chosen.
Result<Envelope> envelope(TriangleView model, const EnvelopeOptions& options = {},
                          const Progress& progress = {});

} // namespace cagewright
