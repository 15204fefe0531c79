/// \file
/// Tetrahedra that fill a cage. Internal to this module.
#pragma once

#include "coordinates/surface.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <array>
#include <cstddef>
#include <vector>

namespace cagewright {

/// A place on a face of a surface.
struct CagePlace {
  std::size_t face = 0;
  std::array<double, 3> hats{};
};

/// Tetrahedra between points on a cage and points inside it, as far as they do not cross the cage.
/// Edges of the cage are edges of tetrahedra, but where the cage is narrower than the spacing.
struct InsideMesh {
  std::vector<Vec3> positions;             ///< in the frame of the surface; those on the cage first
  std::vector<CagePlace> on_cage;          ///< of the first positions
  std::vector<std::array<Index, 4>> cells; ///< in no particular orientation
};

/// How far points are from one another, in the frame, so that there are about so many in all, and
/// not many more than a third of them inside.
double spacing_for(const Surface& surface, std::size_t points);

/// A conforming Delaunay mesh: points on edges and faces of the cage and on a lattice inside, and
/// further ones where the cage is not made of faces and edges of tetrahedra.
///
/// Errors: cancelled; invalid_cage (nothing is inside).
/// Cost: a second for 10,000 points. The same on any number of threads.
Result<InsideMesh> inside_mesh(const Surface& surface, double spacing, const Progress& progress);

} // namespace cagewright
