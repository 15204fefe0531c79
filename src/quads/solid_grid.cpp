#include "quads/solid_grid.h"

#include "envelope/well_composed.h"
#include "mesh/shapes.h"
#include "voxel/bridge.h"
#include "voxel/mirrored_grid.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <utility>

namespace cagewright {
namespace {

// The margin is a little more than the clearance: the surface of the voxels is then strictly clear.
constexpr double margin_factor = 1.06;

TriangleMesh with_image(TriangleView half) {
  TriangleMesh mesh{{half.positions.begin(), half.positions.end()},
                    {half.triangles.begin(), half.triangles.end()}};
  TriangleMesh image = mesh;
  for (Vec3& p : image.positions) {
    p.x() = -p.x();
  }
  for (Triangle& t : image.triangles) {
    std::swap(t[1], t[2]);
  }
  return joined(mesh, image);
}

} // namespace

SolidGrid::SolidGrid(VoxelGrid grid) : grid_(std::move(grid)), low_(grid_.dims) {
  const auto [nx, ny, nz] = grid_.dims;
  sums_.assign(static_cast<std::size_t>(nx + 1) * (ny + 1) * (nz + 1), 0);
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      std::uint32_t row = 0;
      for (int i = 0; i < nx; ++i) {
        if (grid_.occupied(grid_.index(i, j, k))) {
          ++row;
          const std::array<int, 3> cell{i, j, k};
          for (int a = 0; a < 3; ++a) {
            low_[a] = std::min(low_[a], cell[a]);
            high_[a] = std::max(high_[a], cell[a] + 1);
          }
        }
        sums_[sum_at(i + 1, j + 1, k + 1)] = row + sums_[sum_at(i + 1, j, k + 1)] +
                                             sums_[sum_at(i + 1, j + 1, k)] -
                                             sums_[sum_at(i + 1, j, k)];
      }
    }
  }
  grid_.kinds.clear();
}

std::size_t SolidGrid::sum_at(int i, int j, int k) const {
  const auto nx = static_cast<std::size_t>(grid_.dims[0]) + 1;
  const auto ny = static_cast<std::size_t>(grid_.dims[1]) + 1;
  return static_cast<std::size_t>(i) +
         nx * (static_cast<std::size_t>(j) + ny * static_cast<std::size_t>(k));
}

bool SolidGrid::touches(const std::array<int, 3>& l, const std::array<int, 3>& h) const {
  const auto at = [&](int i, int j, int k) { return sums_[sum_at(i, j, k)]; };
  // Unsigned numbers wrap round and back.
  const std::uint32_t top =
      at(h[0], h[1], h[2]) - at(l[0], h[1], h[2]) - at(h[0], l[1], h[2]) + at(l[0], l[1], h[2]);
  const std::uint32_t below =
      at(h[0], h[1], l[2]) - at(l[0], h[1], l[2]) - at(h[0], l[1], l[2]) + at(l[0], l[1], l[2]);
  return top != below;
}

Result<SolidGrid> solid_grid(TriangleView model, const SolidGridOptions& options,
                             const Progress& progress) {
  TriangleMesh both;
  if (options.half) {
    both = with_image(model);
    model = both;
  }
  OrientedBox frame = box_in_frame(options.axes, model.positions);
  VoxelizeOptions voxel;
  voxel.resolution = options.resolution;
  const double size = 2 * frame.half.maxCoeff() / (voxel.resolution - 1);
  voxel.margin = margin_factor * options.clearance / size;
  if (options.half) {
    center_on_mirror_plane(frame, voxel);
  }
  Result<VoxelGrid> grid = voxelize(model, frame, voxel, progress);
  if (!grid) {
    return grid.error();
  }
  std::size_t changed = 0;
  do {
    join_pieces(*grid);
    changed = options.half ? mirror_occupied(*grid) : 0; // bridges do not heed the plane
    changed += fill_cavities(*grid);
  } while (changed > 0);
  return SolidGrid(std::move(*grid));
}

} // namespace cagewright
