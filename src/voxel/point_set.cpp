#include "voxel/point_set.h"

namespace cagewright {

std::vector<Vec3> point_set(TriangleView mesh, const VoxelGrid& grid) {
  std::vector<Vec3> points(mesh.positions.begin(), mesh.positions.end());
  points.reserve(points.size() + grid.kinds.size() - grid.count(VoxelKind::outer));
  for (const VoxelKind kind : {VoxelKind::inner, VoxelKind::feature}) {
    for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
      if (grid.kinds[i] == kind) {
        points.push_back(grid.center(i));
      }
    }
  }
  return points;
}

} // namespace cagewright
