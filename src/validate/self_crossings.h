/// \file
/// Where a model runs through itself.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>

namespace cagewright {

/// How many pairs of triangles cross properly: an edge of the one passes through the inside of the
/// other. Pairs that share an edge, by position, are not looked at; touching and overlapping in a
/// plane do not count. Exact. (A valid cage must not even touch itself: see validate_cage().)
///
/// Errors: cancelled. Cost: O(T log T) time unless very many triangles meet; parallel.
Result<std::size_t> count_self_crossings(TriangleView mesh, const Progress& progress = {});

} // namespace cagewright
