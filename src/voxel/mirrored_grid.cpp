#include "voxel/mirrored_grid.h"

#include <cmath>

namespace cagewright {

void center_on_mirror_plane(OrientedBox& frame, VoxelizeOptions& options) {
  const double size = 2 * frame.half.maxCoeff() / (options.resolution - 1);
  frame.center.x() = 0;
  const double reach = frame.half.x() / size + options.margin + 0.01;
  const int layers = static_cast<int>(std::ceil(reach - 0.5));
  const bool longest = (layers + 0.5) * size >= frame.half.maxCoeff();
  frame.half.x() = (layers + 0.5) * size;
  options.resolution = longest ? 2 * layers + 2 : options.resolution;
}

std::size_t mirror_occupied(VoxelGrid& grid) {
  std::size_t added = 0;
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const auto [x, y, z] = grid.cell(i);
    VoxelKind& image = grid.kinds[grid.index(grid.dims[0] - 1 - x, y, z)];
    if (grid.occupied(i) && image == VoxelKind::outer) {
      image = grid.kinds[i];
      ++added;
    }
  }
  return added;
}

} // namespace cagewright
