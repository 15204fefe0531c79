/// \file
/// Openings of open models, closed. Internal to this module.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// Triangles that close openings of a model.
struct Closures {
  TriangleMesh mesh; ///< its own vertices
  int closed = 0;    ///< openings
  int too_wide = 0;  ///< openings that were left open
};

/// Closes what a model leaves open, so that with the closures it encloses what a person would call
/// its inside:
///
/// 1. Loops of boundary edges (vertices at equal positions are one) get a cap, cut into triangles
///    over the vertices of the loop: the rim of a dome, both ends of a pipe, holes of a scan.
/// 2. Hollows whose walls have a thickness, such as that of a vase, have no boundary edges. A voxel
///    outside belongs to one if it is surrounded in some plane: of eight lines through it in that
///    plane at least seven meet the surface on both sides. What hangs together of such voxels is
///    filled if it has one mouth, however shallow it is; with several mouths (a pipe, a ring) if it
///    is at least half as deep as its mouths are wide, so that the hole of a ring, or of a handle,
///    stays. The closure is the surface through the middles of the voxels, joined to the nearest
///    points of the walls.
///
/// \param widest  openings that are wider stay open, in the model's units; 0: all are closed. Of a
///                loop the width is the second longest edge of its box, of a hollow the shortest of
///                those lines
/// Errors: those of voxelize().
/// Cost: O(T) and, for each of the voxels (64 along the longest edge), 145 directions.
Result<Closures> close_openings(TriangleView model, double widest, const Progress& progress = {});

} // namespace cagewright
