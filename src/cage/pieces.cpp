#include "cage/pieces.h"

#include "voxel/grid_components.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cagewright {
namespace {

constexpr auto unknown = std::numeric_limits<Index>::max();

/// Numbers the groups by their first vertex.
PieceGroups numbered(std::span<const std::size_t> labels, std::size_t bound) {
  PieceGroups groups;
  std::vector<Index> number(bound, unknown);
  for (const std::size_t label : labels) {
    if (number[label] == unknown) {
      number[label] = static_cast<Index>(groups.count++);
    }
    groups.group_of.push_back(number[label]);
  }
  return groups;
}

std::size_t voxel_of(const VoxelGrid& grid, const Vec3& p) {
  const Vec3 at = grid.to_grid(p);
  std::array<int, 3> cell{};
  for (std::size_t k = 0; k < 3; ++k) {
    cell[k] = std::clamp(static_cast<int>(std::floor(at[static_cast<Eigen::Index>(k)])), 0,
                         grid.dims[k] - 1);
  }
  return grid.index(cell);
}

} // namespace

Result<PieceGroups> piece_groups(TriangleView model, double clearance, int resolution,
                                 const Progress& progress) {
  const Box3 box = bounding_box(model.positions);
  OrientedBox frame;
  frame.center = box.center();
  frame.axes = Mat3::Identity();
  frame.half = box.sizes() / 2;
  VoxelizeOptions options;
  options.resolution = resolution;
  const double size = 2 * frame.half.maxCoeff() / (resolution - 1);
  options.margin = clearance * box.diagonal().norm() / size;
  const Result<VoxelGrid> grid = voxelize(model, frame, options, progress);
  if (!grid) {
    return grid.error();
  }
  const GridComponents pieces = grid_components(*grid);
  std::vector<std::size_t> labels;
  labels.reserve(model.positions.size());
  for (const Vec3& p : model.positions) {
    // Every vertex lies in a voxel of the surface.
    labels.push_back(static_cast<std::size_t>(std::max(0, pieces.labels[voxel_of(*grid, p)])));
  }
  return numbered(labels, static_cast<std::size_t>(pieces.count) + 1);
}

PieceGroups joined_groups(const PieceGroups& groups, std::span<const std::size_t> into) {
  std::vector<std::size_t> labels;
  labels.reserve(groups.group_of.size());
  for (const Index g : groups.group_of) {
    std::size_t target = g;
    while (into[target] != target) {
      target = into[target];
    }
    labels.push_back(target);
  }
  return numbered(labels, groups.count);
}

std::vector<ModelPart> parts_of(TriangleView model, const PieceGroups& groups) {
  std::vector<ModelPart> parts(groups.count);
  std::vector<Index> place(model.positions.size());
  for (Index v = 0; v < model.positions.size(); ++v) {
    ModelPart& part = parts[groups.group_of[v]];
    place[v] = static_cast<Index>(part.vertices.size());
    part.vertices.push_back(v);
    part.mesh.positions.push_back(model.positions[v]);
  }
  for (const Triangle& t : model.triangles) {
    parts[groups.group_of[t[0]]].mesh.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  return parts;
}

} // namespace cagewright
