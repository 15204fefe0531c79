/// \file
/// Triangles of a cage made into quads, two by two.
#pragma once

#include "quads/direction_field.h"
#include "quads/quad_guard.h"

namespace cagewright {

/// What a set of faces costs; lower is better.
struct Taste {
  FaceWishes wishes = {};
  double alignment = 1;   ///< of each side, the field's misalignment
  double tentative = 0.5; ///< of a quad that is valid along one diagonal only
  double valence = 0.35;  ///< of each vertex, (faces at it - 4)^2
  /// Of what is enclosed by some faces and not by those that they take the place of, in volumes
  /// a^1.5, a the mean area of the latter.
  double volume = 12;
};

/// face_defect() and the misalignment of the face's sides, each of which belongs to two faces.
double cost_of(std::span<const Vec3> positions, const DirectionField& field, const Taste& taste,
               const CageFace& face);

/// Two triangles with a common side, and the quad that they cover.
struct PairOfTriangles {
  Index left = 0;
  Index right = 0;
  CageFace quad;
};
std::vector<PairOfTriangles> neighboring_triangles(const QuadCage& cage);

/// Makes quads of as many pairs of triangles as can be, the best shaped first. The cage stays
/// valid, under every choice of diagonals. \returns how many
std::size_t pair_triangles(QuadCage& cage, const QuadGuard& guard, const DirectionField& field,
                           const Taste& taste);

} // namespace cagewright
