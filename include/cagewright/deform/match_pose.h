/// \file
/// A cage that comes back from another program with its vertices moved.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <string>
#include <vector>

namespace cagewright {

struct MatchedPose {
  std::vector<Vec3> positions; ///< C: where each vertex of the cage at rest has gone
  /// What was taken otherwise than it stands, such as "its faces are others: those of the cage at
  /// rest are taken"; empty: nothing.
  std::string note;
};

/// Finds the vertices of a cage at rest in a posed cage. The posed one may cut its faces otherwise,
/// begin them at other corners or list them in another order; it may have its vertices in another
/// order where its faces are in the same; split or merged vertices; and loose vertices more or
/// fewer. Vertices correspond by number where the edges of the two agree, up to diagonals of faces;
/// else by the corners of the faces, one by one.
///
/// \param rest   C vertices
/// \param what   "posed.obj", for the message
/// Errors: mismatch, with both counts and what helps.
/// Cost: O(C + F) log.
Result<MatchedPose> match_pose(const PolygonMesh& rest, const PolygonMesh& posed,
                               const std::string& what);

} // namespace cagewright
