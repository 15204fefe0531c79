/// \file
/// A model in several pieces, and the parts of it that get a cage of their own.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// Groups of pieces of a model that are apart: for each vertex the number of its group.
struct PieceGroups {
  std::vector<Index> group_of; ///< V numbers < count
  std::size_t count = 0;       ///< groups are numbered by their first vertex
};

/// Pieces belong to one group when the voxels that come within the clearance of them, or lie inside
/// them, hang together: pieces that touch, nearly touch, or lie one within another.
///
/// \param clearance   in diagonals of the model's box
/// \param resolution  voxels along the longest edge of the model's box
/// Errors: those of voxelize().
Result<PieceGroups> piece_groups(TriangleView model, double clearance, int resolution,
                                 const Progress& progress = {});

/// Joins groups. `into[g]` is the group that g becomes part of; chains are followed.
PieceGroups joined_groups(const PieceGroups& groups, std::span<const std::size_t> into);

/// One group of a model as a model.
struct ModelPart {
  TriangleMesh mesh;
  std::vector<Index> vertices; ///< for each of its vertices, the model's
};

std::vector<ModelPart> parts_of(TriangleView model, const PieceGroups& groups);

} // namespace cagewright
