#include "mesh/mesh_part.h"

#include <limits>

namespace cagewright {

MeshPart part_of(const PolygonMesh& mesh, const std::vector<bool>& faces) {
  constexpr Index unused = std::numeric_limits<Index>::max();
  std::vector<Index> number(mesh.positions.size(), unused);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (faces[f]) {
      for (const Index v : mesh.face(f)) {
        number[v] = 0;
      }
    }
  }
  MeshPart part;
  part.mesh.group_names = mesh.group_names;
  for (Index v = 0; v < number.size(); ++v) { // the order of the file
    if (number[v] == unused) {
      continue;
    }
    number[v] = static_cast<Index>(part.vertices.size());
    part.vertices.push_back(v);
    part.mesh.positions.push_back(mesh.positions[v]);
    if (!mesh.colors.empty()) {
      part.mesh.colors.push_back(mesh.colors[v]);
    }
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!faces[f]) {
      continue;
    }
    std::vector<Index> corners(mesh.face(f).begin(), mesh.face(f).end());
    for (Index& v : corners) {
      v = number[v];
    }
    part.mesh.add_face(corners);
    if (!mesh.face_groups.empty()) {
      part.mesh.face_groups.push_back(mesh.face_groups[f]);
    }
  }
  return part;
}

} // namespace cagewright
