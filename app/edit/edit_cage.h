/// \file
/// Changes of a cage's topology that keep it closed, manifold and oriented.
#pragma once

#include "app/edit/selection.h"
#include "mesh/topology.h"
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <span>
#include <vector>

namespace cagewright::app {

/// A cage after a change.
struct EditedCage {
  static constexpr Index none = ~Index{0};

  PolygonMesh mesh;              ///< only vertices that faces use
  std::vector<Index> new_of_old; ///< for each old vertex its new number, or `none`
  std::vector<Index> old_of_new; ///< for each new vertex the old one, or `none` for one that is new
  Selection selection;           ///< what one would go on with
};

/// All of these take a cage that is closed, manifold and oriented and return another such, of as
/// many pieces and handles as before; else they return invalid_cage with the reason. Whether the
/// cage still is a cage of its model is for others to judge. Vertices and faces that are left keep
/// their order; new ones come last. Groups of faces are kept.
///
/// Cost: O(C log C) for C corners.

/// A new vertex in the middle of each edge; the faces beside it are cut so that no three corners
/// lie on a line: a triangle in two triangles, a quad with two opposite new vertices in two quads.
Result<EditedCage> split_edges(const PolygonMesh& cage, std::span<const EdgeVertices> edges);

/// Splits the edges of whole rings: loops of edges through the middle of runs of quads.
Result<EditedCage> split_rings(const PolygonMesh& cage, std::span<const EdgeVertices> edges);

/// Cuts one run of quads along its middle, once or several times: new loops of edges from each edge
/// of the ring of `edge` to the next. Triangles at the ends of the run are cut to fit.
/// \param cuts   how many loops, 1 or more, evenly spaced
/// \param slide  in (-1, 1): moves all of them, at most to the ends of the ring's edges; positive
///                towards edge[1], and to the same side all along the ring
Result<EditedCage> cut_loops(const PolygonMesh& cage, const EdgeVertices& edge, int cuts,
                             double slide);

/// Each edge drawn together to its middle. Edges that touch become one point.
Result<EditedCage> collapse_edges(const PolygonMesh& cage, std::span<const EdgeVertices> edges);

/// Each edge turned to the next corners of the two faces beside it: the other diagonal of two
/// triangles. One after the other.
Result<EditedCage> flip_edges(const PolygonMesh& cage, std::span<const EdgeVertices> edges);

/// Each face in quads round its middle; triangles in four. Faces next to it are cut to fit.
Result<EditedCage> subdivide_faces(const PolygonMesh& cage, std::span<const Index> faces);

/// What is selected goes, and the cage closes over it: the faces round a vertex become one (cut in
/// triangles if it has more than four corners), the faces on both sides of an edge become one, each
/// connected set of faces becomes one, or as few triangles as its outline needs, and stays
/// selected. Faces with no vertex between them to go are refused.
Result<EditedCage> delete_elements(const PolygonMesh& cage, const Selection& selection);

/// Each connected set of faces moves outward along its mean normal, with new quads at its rim.
/// \param offset  how far, in the cage's unit; must not be 0
Result<EditedCage> extrude_faces(const PolygonMesh& cage, std::span<const Index> faces,
                                 double offset);

/// How far one would extrude these faces: a third of the mean length of their edges.
double extrusion_offset(const PolygonMesh& cage, std::span<const Index> faces);

} // namespace cagewright::app
