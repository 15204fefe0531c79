/// \file
/// What the quads of a cage are like.
#pragma once

#include <cstddef>

namespace cagewright {

struct QuadReport {
  std::size_t quads = 0;
  std::size_t triangles = 0;
  double share = 0;             ///< of quads among the faces
  double max_bend_degrees = 0;  ///< of all quads: between the two triangles of either cut
  double max_angle_degrees = 0; ///< at a corner of any quad
  double min_angle_degrees = 0;
  /// Strips of quads, each the neighbour of the next across opposite sides, that close on
  /// themselves.
  std::size_t rings = 0;
  /// Closed loops of edges that go straight on at every vertex, four quads meeting there: round
  /// limbs, and round the body.
  std::size_t loops = 0;
  /// Of the triangles that triangulate() makes, the share whose 2 r / R is below 0.15, and the
  /// least 2 r / R.
  double thin = 0;
  double least_quality = 0;
};

} // namespace cagewright
