/// \file
/// What a model file holds beside the shape: how its surface is dressed.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace cagewright {

/// One number for each vertex or face, under a name of the file's own (PLY properties such as
/// "quality").
struct NamedValues {
  std::string name;
  bool is_integer = false;    ///< stored as an integer, to be written as one
  std::vector<double> values; ///< V or F
};

/// Attributes of a PolygonMesh of V vertices, F faces and C corners (PolygonMesh::corners()). Every
/// list may be empty: then the file has none. Vertex colours and groups are in the mesh itself.
struct MeshAttributes {
  static constexpr Index none = std::numeric_limits<Index>::max();

  std::vector<std::array<double, 2>> texture_points; ///< as stored: v upwards, as in OBJ
  std::vector<Index> texture_of_corner;              ///< C indices of texture_points, or `none`
  std::vector<Vec3> normals;                         ///< as stored, not made unit
  std::vector<Index> normal_of_corner;               ///< C indices of normals, or `none`
  std::vector<std::string> material_files;           ///< names of material libraries (OBJ, MTL)
  std::vector<std::string> material_names;
  std::vector<Index> face_materials;             ///< F indices of material_names, or `none`
  std::vector<std::array<float, 4>> face_colors; ///< F colours in [0, 1]
  std::vector<NamedValues> vertex_values;
  std::vector<NamedValues> face_values;
  /// Of each of PolygonMesh::group_names the object that the group belongs to, or nothing (OBJ).
  std::vector<std::string> group_objects;
  std::vector<std::string> comments; ///< lines of comments in the header (PLY, OBJ)
  /// What the file holds and no list above can, in words for a person: "lines", "skins".
  std::vector<std::string> others;
};

} // namespace cagewright
