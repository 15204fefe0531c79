/// \file
/// A cage of blocks: the cells of a grid of few planes that a model touches.
#pragma once

#include "quads/solid_grid.h"
#include <cagewright/core/progress.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <array>
#include <vector>

namespace cagewright {

struct GridLayoutOptions {
  int vertices = 100; ///< at most so many on the whole surface
  bool half = false;  ///< planes are mirrored in x = 0, which is one of them
};

/// Planes across the three axes, as places in a SolidGrid, from the first to the last, and the
/// cells between them that are filled.
struct GridLayout {
  std::array<std::vector<int>, 3> planes;
  VoxelGrid cells;          ///< only its dims and kinds: with a layer of outer cells all round
  double volume = 0;        ///< of the filled cells, in voxels
  std::size_t vertices = 0; ///< of their surface
  int genus = 0;            ///< and its handles
};

/// Drops planes from the finest layout, always the one that costs least volume for the vertices it
/// saves, until the surface has no more than so many; then shifts the planes that are left, and
/// exchanges one for another, while that lessens the volume. A limb between two neighbouring
/// planes each way has four sides, and every plane across it is a ring of edges round it.
///
/// The surface of the filled cells is one closed manifold of quads.
/// When it is cancelled the layout is whatever it was by then.
GridLayout grid_layout(const SolidGrid& solid, const GridLayoutOptions& options,
                       const Progress& progress = {});

/// The surface of the layout, outward. With `half`, the part at x >= 0: its border lies in the
/// plane x = 0 exactly.
PolygonMesh surface_of(const GridLayout& layout, const SolidGrid& solid, bool half);

} // namespace cagewright
