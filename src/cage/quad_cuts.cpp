#include "cage/quad_cuts.h"

#include "validate/greatest_gap.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace cagewright {

std::array<TriangleMesh, 2> cuts_of(const PolygonMesh& cage) {
  std::array<TriangleMesh, 2> result;
  for (std::size_t diagonal = 0; diagonal < result.size(); ++diagonal) {
    TriangleMesh& mesh = result[diagonal];
    mesh.positions = cage.positions;
    for (std::size_t f = 0; f < cage.face_count(); ++f) {
      const std::span<const Index> face = cage.face(f);
      const std::size_t k = face.size() == 4 ? diagonal : 0;
      mesh.triangles.push_back({face[k], face[k + 1], face[k + 2]});
      if (face.size() == 4) {
        mesh.triangles.push_back({face[k], face[k + 2], face[(k + 3) % 4]});
      }
    }
  }
  return result;
}

double greatest_gap_along_any(const PolygonMesh& cage, const TriangleBvh& model, double tolerance) {
  const std::array<TriangleMesh, 2> cuts = cuts_of(cage);
  return std::max(greatest_gap(cuts[0], model, tolerance).upper,
                  greatest_gap(cuts[1], model, tolerance).upper);
}

} // namespace cagewright
