/// \file
/// The Boolean union of convex solids as one surface.
#pragma once

#include "cage/hexahedron.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <span>

namespace cagewright {

struct UniteOptions {
  /// The solids are first made larger by distinct amounts in (0, separation], in the solids' own
  /// units: then no two faces of neighbours coincide, and solids that touch overlap. 0 stands for a
  /// thousandth of the diagonal of all solids. Corners of shared faces stay where they are.
  double separation = 0;

  /// How often to try again with other amounts when a union is not a manifold or does not survive
  /// the rounding to doubles.
  int attempts = 4;
};

/// Whether this build has the union: it was not switched off (CAGEWRIGHT_WITH_BOXES).
bool can_unite();

/// The outer boundary of the union of S solids: closed, edge- and vertex-manifold, oriented
/// outward, without degenerate triangles or self-intersections, checked exactly on the doubles that
/// are returned.
///
/// Inner walls are gone and enclosed cavities are filled; tunnels stay. Solids that are apart give
/// several components. A solid that is inside out counts as its mirror image. Every solid lies
/// within the result, up to the rounding of its corners.
///
/// Where flat faces are left they are triangulated without further vertices, by a constrained
/// Delaunay triangulation of the face.
///
/// The unions are exact (corefinement with exact constructions, after Loriot, Rouxel-Labbe,
/// Tournois and Yaz, "Polygon Mesh Processing", CGAL User Manual 5.5), pairwise in a balanced tree
/// over space. The result does not depend on the number of threads.
///
/// Errors: not_available (see can_unite()), invalid_option (no solid, a solid without volume or not
/// finite), no_valid_cage, cancelled.
/// Cost: a tenth of a second for the 32 boxes of a character, up to two seconds for 110 boxes that
/// overlap much, on two idle cores.
Result<TriangleMesh> unite(std::span<const Hexahedron> solids, const UniteOptions& options = {},
                           const Progress& progress = {});

} // namespace cagewright
