#include "cage/decompose.h"

#include "obb/principal_axes.h"
#include "voxel/bridge.h"
#include "voxel/point_set.h"
#include "voxel/voxelize.h"

#include <utility>

namespace cagewright {

DecomposeOptions decompose_options(const GenerateOptions& options) {
  return {.resolution = options.resolution,
          .pieces = options.pieces,
          .slicing = {.rule = options.slicing,
                      .depth = options.depth,
                      .max_boxes = options.max_boxes,
                      .split_parts = options.split_parts,
                      .eta = options.eta,
                      .zeta = options.zeta,
                      .min_jump = options.min_jump,
                      .no_jump = options.no_jump,
                      .min_gain = options.min_gain}};
}

VoxelGrid in_grid_coordinates(const VoxelGrid& grid) {
  VoxelGrid plain;
  plain.dims = grid.dims;
  plain.kinds = grid.kinds;
  return plain;
}

Result<BoxDecomposition> decompose(TriangleView model, const DecomposeOptions& options,
                                   const Progress& progress) {
  if (options.resolution < 8 || options.resolution > 512) {
    return Error{ErrorCode::invalid_option, "resolution must be from 8 to 512"};
  }
  if (!(options.clearance >= 0 && options.clearance < 1)) {
    return Error{ErrorCode::invalid_option, "the clearance must be at least 0 and below 1"};
  }
  const Result<UnitFrame> frame = unit_frame(model);
  if (!frame) {
    return frame.error();
  }
  BoxDecomposition made;
  made.frame = *frame;
  Stopwatch watch(made.times);
  const std::vector<Vec3> positions = to_unit(*frame, model.positions);
  const TriangleView unit{positions, model.triangles};
  const auto voxels_in = [&](const OrientedBox& box) {
    constexpr double a_little_more = 1.05; // the boxes are then strictly clear
    const double size = 2 * box.half.maxCoeff() / (options.resolution - 1);
    return VoxelizeOptions{.resolution = options.resolution,
                           .margin = a_little_more * options.clearance / size};
  };

  made.vertex_box = pca_box(positions);
  Result<VoxelGrid> first =
      voxelize(unit, made.vertex_box, voxels_in(made.vertex_box), progress.part(0, 0.15));
  if (!first) {
    return first.error();
  }
  made.point_box = pca_box(point_set(unit, *first));
  watch.lap("first voxels");

  Result<VoxelGrid> second =
      voxelize(unit, made.point_box, voxels_in(made.point_box), progress.part(0.15, 0.3));
  if (!second) {
    return second.error();
  }
  made.grid = std::move(*second);
  if (options.pieces == Pieces::together) {
    made.bridges = join_pieces(made.grid);
  }
  watch.lap("voxels");

  Result<BoxTree> tree =
      build_box_tree(in_grid_coordinates(made.grid), options.slicing, progress.part(0.3, 1));
  if (!tree) {
    return tree.error();
  }
  made.tree = std::move(*tree);
  watch.lap("slicing");
  return made;
}

} // namespace cagewright
