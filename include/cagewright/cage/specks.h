/// \file
/// Tiny pieces of a model that lie far from the rest of it.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <vector>

namespace cagewright {

/// What find_specks() found.
struct Specks {
  std::vector<bool> of_vertex; ///< of each of the V vertices of the model, whether it is in a speck
  std::size_t count = 0;       ///< pieces, or vertices that no face uses
  std::size_t triangles = 0;   ///< of them
  Vec3 place = Vec3::Zero();   ///< a vertex of the first
  double enlargement = 1;      ///< the diagonal of the model's box, over that of the rest

  /// Of each of the F faces of the model, whether it is in no speck.
  [[nodiscard]] std::vector<bool> faces_in_none(const PolygonMesh& model) const;
};

/// Finds what scans and exports leave in space: specks of dust, a triangle or a vertex at a
/// million.
///
/// The model's pieces (connected by vertices at equal positions) fall into groups that are more
/// than 5 % of the diagonal apart; that with the greatest area is the body. A group is a speck if
/// its area is at most 1 % of the body's, and no piece of it is longer than 5 % of the body's
/// diagonal. The diagonal is that of what is no speck. Vertices that no face uses are pieces
/// without area. Distances are those of voxels, to within a quarter of them.
///
/// Errors: those of voxelize().
/// Cost: O(V + T); a grid of 64 voxels along the longest axis, and one more for each order of
/// magnitude that specks are away, where there is more than one piece.
Result<Specks> find_specks(TriangleView model, const Progress& progress = {});

/// Of each of the F faces of a model, whether it is in no speck: see Specks::faces_in_none().
/// Errors, cost: those of find_specks().
Result<std::vector<bool>> faces_in_no_speck(const PolygonMesh& model,
                                            const Progress& progress = {});

} // namespace cagewright
