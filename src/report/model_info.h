/// \file
/// What can be said of a model before it has a cage.
#pragma once

#include "mesh/topology.h"
#include "obb/oriented_box.h"
#include "voxel/voxelize.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/symmetry/mirror_pairing.h>
#include <cagewright/validate/model_volume.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace cagewright {

struct NamedBox {
  const char* key;   // in JSON
  const char* title; // for people
  OrientedBox box;
};

struct ModelInfo {
  std::size_t vertices = 0;
  std::size_t distinct_positions = 0;
  std::map<std::size_t, std::size_t> faces_by_sides;
  TopologyReport topology; // after merging equal positions
  std::size_t unused_vertices = 0;
  std::size_t degenerate_triangles = 0; // without area, or naming a vertex twice
  std::size_t self_crossings = 0;
  double diagonal = 0;
  double area = 0;
  ModelVolume volume;
  std::vector<NamedBox> boxes;
  std::optional<MirrorPlane> mirror;

  [[nodiscard]] std::size_t faces() const {
    std::size_t sum = 0;
    for (const auto& [sides, count] : faces_by_sides) {
      sum += count;
    }
    return sum;
  }
};

/// Counts, topology, self-intersections, sizes, boxes and the mirror plane of a model.
///
/// \param voxels  for the box of vertices and voxels
/// Errors: cancelled.
Result<ModelInfo> describe_model(const PolygonMesh& model, const VoxelizeOptions& voxels,
                                 const Progress& progress);

nlohmann::json json_of(const ModelInfo& info);

} // namespace cagewright
