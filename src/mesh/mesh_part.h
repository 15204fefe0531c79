/// \file
/// Some faces of a mesh as a mesh. Internal to this repository.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>

#include <vector>

namespace cagewright {

/// A part of a mesh, with the vertices that its faces use.
struct MeshPart {
  PolygonMesh mesh;
  std::vector<Index> vertices; ///< for each of them its number in the whole
};

/// \param faces  of each of the F faces, whether it is of the part
MeshPart part_of(const PolygonMesh& mesh, const std::vector<bool>& faces);

} // namespace cagewright
