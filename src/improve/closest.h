/// \file
/// Nearest points of two small pieces: a point, a segment, a triangle. In doubles; degenerate
/// pieces are the segment or the point that their corners span.
#pragma once

#include "core/geometry.h"

#include <array>

namespace cagewright {

/// Three corners by value.
using Corners = std::array<Vec3, 3>;

/// Two points, one of each piece, that are nearest to each other.
struct NearestPair {
  double squared = 0; ///< their distance, squared
  Vec3 first;
  Vec3 second;
};

/// The point of the triangle nearest to p (Ericson, "Real-Time Collision Detection", 5.1.5).
Vec3 nearest_in_triangle(const Vec3& p, const Corners& t);

NearestPair nearest_of_segments(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s);

/// The nearest pair of two triangles, zero apart where they meet. Far from exact contact the error
/// is that of rounding; within it the answer is zero or a rounding error.
NearestPair nearest_of_triangles(const Corners& a, const Corners& b);

} // namespace cagewright
