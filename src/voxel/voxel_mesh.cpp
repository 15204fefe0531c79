#include "voxel/voxel_mesh.h"

#include <limits>
#include <string>

namespace cagewright {
namespace {

std::string name_of(VoxelKind kind) {
  return kind == VoxelKind::outer ? "outer" : kind == VoxelKind::inner ? "inner" : "feature";
}

class Builder {
public:
  explicit Builder(const VoxelGrid& grid)
      : grid_(grid), vertices_(static_cast<std::size_t>(grid.dims[0] + 1) * (grid.dims[1] + 1) *
                                   (grid.dims[2] + 1),
                               none) {}

  void add(VoxelKind kind) {
    const auto group = static_cast<Index>(mesh_.group_names.size());
    mesh_.group_names.push_back(name_of(kind));
    for (std::size_t i = 0; i < grid_.kinds.size(); ++i) {
      if (grid_.kinds[i] == kind) {
        add_quads(grid_.cell(i), kind);
      }
    }
    mesh_.face_groups.resize(mesh_.face_count(), group);
  }

  PolygonMesh take() { return std::move(mesh_); }

private:
  static constexpr Index none = std::numeric_limits<Index>::max();

  void add_quads(const std::array<int, 3>& cell, VoxelKind kind) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beyond = cell;
        beyond[axis] += 2 * side - 1;
        const bool in_grid = beyond[axis] >= 0 && beyond[axis] < grid_.dims[axis];
        if (!in_grid || grid_.kinds[grid_.index(beyond)] != kind) {
          add_quad(cell, axis, side);
        }
      }
    }
  }

  void add_quad(const std::array<int, 3>& cell, int axis, int side) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    std::array<int, 3> corner = cell;
    corner[axis] += side;
    const Index a = vertex(corner);
    ++corner[u];
    const Index b = vertex(corner);
    ++corner[v];
    const Index c = vertex(corner);
    --corner[u];
    const Index d = vertex(corner);
    side == 1 ? mesh_.add_face({a, b, c, d}) : mesh_.add_face({a, d, c, b});
  }

  Index vertex(const std::array<int, 3>& corner) {
    const std::size_t nx = static_cast<std::size_t>(grid_.dims[0]) + 1;
    const std::size_t ny = static_cast<std::size_t>(grid_.dims[1]) + 1;
    Index& v = vertices_[corner[0] + nx * (corner[1] + ny * corner[2])];
    if (v == none) {
      v = static_cast<Index>(mesh_.positions.size());
      mesh_.positions.push_back(grid_.corner(corner[0], corner[1], corner[2]));
    }
    return v;
  }

  const VoxelGrid& grid_;
  std::vector<Index> vertices_; // of the grid's corners, or none
  PolygonMesh mesh_;
};

} // namespace

PolygonMesh voxel_boxes(const VoxelGrid& grid, const std::vector<VoxelKind>& kinds) {
  Builder builder(grid);
  for (const VoxelKind kind : kinds) {
    builder.add(kind);
  }
  return builder.take();
}

} // namespace cagewright
