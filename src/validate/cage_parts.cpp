#include "validate/cage_parts.h"

#include "exact/predicates.h"
#include <cagewright/mesh/triangulate.h>

#include <algorithm>

namespace cagewright {
namespace {

constexpr std::uint8_t both_cuttings = 3;

class Cutter {
public:
  Cutter(const PolygonMesh& cage, CageParts& result) : cage_(cage), result_(result) {}

  void cut(Index f) {
    const std::span<const Index> face = cage_.face(f);
    const bool finite = std::all_of(face.begin(), face.end(),
                                    [&](Index v) { return cage_.positions[v].allFinite(); });
    if (!finite) {
      return;
    }
    if (face.size() == 3) {
      add(f, {0, 1, 2}, both_cuttings);
    } else if (face.size() == 4) {
      result_.has_two_cuttings = true;
      add(f, {0, 1, 2}, 1);
      add(f, {0, 2, 3}, 1);
      add(f, {1, 2, 3}, 2);
      add(f, {1, 3, 0}, 2);
    } else {
      cut_large(f);
    }
  }

private:
  void cut_large(Index f) {
    const std::span<const Index> face = cage_.face(f);
    PolygonMesh alone;
    std::vector<Index> ring;
    for (const Index v : face) {
      ring.push_back(static_cast<Index>(alone.positions.size()));
      alone.positions.push_back(cage_.positions[v]);
    }
    alone.add_face(ring);
    for (const Triangle& t : triangulate(alone).triangles) {
      add(f, t, both_cuttings);
    }
  }

  /// `local` counts within the face.
  void add(Index f, const Triangle& local, std::uint8_t cuttings) {
    const std::span<const Index> face = cage_.face(f);
    CagePart part{{}, f, cuttings, 0, false};
    for (unsigned k = 0; k < 3; ++k) {
      part.corners[k] = result_.welded.point_of[face[local[k]]];
      if ((local[k] + 1) % face.size() == local[(k + 1) % 3]) {
        part.sides |= static_cast<std::uint8_t>(1U << k);
      }
    }
    part.is_degenerate =
        is_degenerate(result_.point(part, 0), result_.point(part, 1), result_.point(part, 2));
    result_.parts.push_back(part);
    result_.triangles.push_back(part.corners);
  }

  const PolygonMesh& cage_;
  CageParts& result_;
};

} // namespace

CageParts cut_into_parts(const PolygonMesh& cage) {
  CageParts result;
  result.welded = weld_points(cage.positions);
  Cutter cutter(cage, result);
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    result.first_of_face.push_back(result.parts.size());
    cutter.cut(static_cast<Index>(f));
  }
  result.first_of_face.push_back(result.parts.size());
  result.bvh = TriangleBvh({result.welded.positions, result.triangles});
  return result;
}

bool parts_cross(const CageParts& cage, const CagePart& a, const CagePart& b) {
  if (a.face != b.face) {
    // Two faces may share a side. They may not share a diagonal, with each other or with a side:
    // cut along it they would touch there.
    int shared = 0;
    bool has_diagonal = false;
    for (unsigned k = 0; k < 3; ++k) {
      for (unsigned l = 0; l < 3; ++l) {
        const bool same =
            a.corners[k] == b.corners[(l + 1) % 3] && a.corners[(k + 1) % 3] == b.corners[l];
        const bool same_way =
            a.corners[k] == b.corners[l] && a.corners[(k + 1) % 3] == b.corners[(l + 1) % 3];
        if (same || same_way) {
          ++shared;
          has_diagonal = has_diagonal || (a.sides >> k & 1U) == 0 || (b.sides >> l & 1U) == 0;
        }
      }
    }
    if (shared > 0 && has_diagonal) {
      return true;
    }
  }
  return faces_cross(cage.welded.positions, a.corners, b.corners);
}

} // namespace cagewright
