/// \file
/// A cage as the triangles that any program may cut it into.
#pragma once

#include "spatial/bvh.h"
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/mesh/weld.h>

#include <cstdint>
#include <vector>

namespace cagewright {

/// A triangle of a face. A quad has four: two for each diagonal.
struct CagePart {
  Triangle corners; ///< into CageParts::points, in which equal positions are one point
  Index face;
  /// Which cuttings of the cage it belongs to: bit 0 the one along the quads' first diagonals,
  /// bit 1 the one along their second. Triangles and larger faces are in both.
  std::uint8_t cuttings;
  std::uint8_t sides; ///< bit k: the side from corner k to k + 1 is a side of the face
  bool is_degenerate; ///< has no area
};

/// The parts of all faces, face after face, and a hierarchy over them.
struct CageParts {
  WeldedPoints welded;
  std::vector<CagePart> parts;
  std::vector<std::size_t> first_of_face; ///< F + 1 offsets into parts
  TriangleBvh bvh;
  bool has_two_cuttings = false;

  /// The triangles of the parts, for views.
  std::vector<Triangle> triangles;

  [[nodiscard]] const Vec3& point(const CagePart& part, int corner) const {
    return welded.positions[part.corners[corner]];
  }
};

/// Cuts a cage whose every corner is a vertex and whose faces have three corners or more; a face
/// with a coordinate that is not finite gets no parts.
CageParts cut_into_parts(const PolygonMesh& cage);

/// True when two parts of one cage meet where they should not: parts of different faces, or of
/// one face in the same cutting. Neither is degenerate. Exact.
bool parts_cross(const CageParts& cage, const CagePart& a, const CagePart& b);

} // namespace cagewright
