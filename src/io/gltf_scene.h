/// \file
/// What a glTF file shows, and where each vertex of it comes from.
#pragma once

#include "io/gltf_document.h"
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <vector>

namespace cagewright {

/// Vertices of an accessor as a node places them.
struct GltfPlacement {
  std::size_t node = 0;
  std::size_t positions = 0; ///< accessor
  Index base = 0;            ///< of the first vertex in the mesh
  std::size_t count = 0;
  Eigen::Affine3d transform; ///< from the accessor's frame to the scene's
};

/// The triangles of one primitive under one node.
struct GltfShown {
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
};

/// Reads the default scene. Errors: those of read_mesh().
Result<GltfScene> read_gltf_scene(GltfDocument& document);

} // namespace cagewright
