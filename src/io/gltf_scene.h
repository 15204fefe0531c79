/// \file
/// What a glTF file shows, and where each vertex of it comes from.
#pragma once

#include "io/gltf_document.h"
#include "io/gltf_pose.h"
#include "io/reading.h"
#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {

/// Vertices of an accessor as a node and its joints place them.
struct GltfPlacement {
  std::size_t node = 0;
  std::size_t positions = 0; ///< accessor
  Index base = 0;            ///< of the first vertex in the mesh
  std::size_t count = 0;
  Eigen::Affine3d transform;           ///< from the mesh's frame to the scene's, unless skinned
  std::vector<Eigen::Affine3d> blends; ///< of a skinned mesh: the transform of each vertex
  std::vector<Vec3> shifts;            ///< what the morph targets add to each vertex, or none
  std::vector<double> morph_weights;   ///< of the targets, 0 in the bind pose

  [[nodiscard]] const Eigen::Affine3d& transform_of(std::size_t v) const {
    return blends.empty() ? transform : blends[v];
  }
  [[nodiscard]] Vec3 shift_of(std::size_t v) const {
    return shifts.empty() ? Vec3(Vec3::Zero()) : shifts[v];
  }
};

/// The triangles of one primitive under one node.
struct GltfShown {
  std::size_t node = 0;
  std::size_t mesh = 0;
  std::size_t primitive = 0; ///< of the mesh
  std::size_t placement = 0;
  std::optional<std::size_t> normals;  ///< accessor
  std::optional<std::size_t> tangents; ///< accessor
  std::size_t first_corner = 0;        ///< of the mesh
  std::size_t end_corner = 0;
};

struct GltfScene {
  PolygonMesh mesh;
  std::vector<GltfPlacement> placements;
  std::vector<GltfShown> shown;
  NoteList notes;
};

/// Reads the default scene. Errors: those of read_mesh().
Result<GltfScene> read_gltf_scene(GltfDocument& document, Pose pose);

} // namespace cagewright
