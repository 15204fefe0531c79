#include "cage/generate.h"

#include "cage/unite.h"
#include "obb/principal_axes.h"
#include "validate/validate_cage.h"
#include "voxel/bridge.h"
#include "voxel/point_set.h"
#include "voxel/voxelize.h"

#include <chrono>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

/// Boxes grow by distinct amounts up to this part of a voxel before they are united, so that no two
/// of their faces coincide.
constexpr double separation = 0.2;

/// Shares of the whole time, for the progress bar.
constexpr double decomposed = 0.3;
constexpr double registered = 0.35;
constexpr double united = 0.9;

class Stopwatch {
public:
  explicit Stopwatch(std::vector<StageTime>& times) : times_(times) {}

  /// Notes the time since the last lap under the name of the stage that has just ended.
  void lap(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    times_.push_back({stage, std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

private:
  std::vector<StageTime>& times_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::optional<Error> bad_option(const GenerateOptions& options) {
  if (options.resolution < 8 || options.resolution > 512) {
    return Error{ErrorCode::invalid_option, "resolution must be from 8 to 512"};
  }
  return std::nullopt;
}

std::vector<Hexahedron> to_model_units(const UnitFrame& frame, std::vector<Hexahedron> solids) {
  for (Hexahedron& solid : solids) {
    for (Vec3& corner : solid.corners) {
      corner = frame.from_unit(corner);
    }
  }
  return solids;
}

/// The error that tells a caller why the result of the pipeline cannot be trusted.
Error not_valid(const ValidityReport& report) {
  return {ErrorCode::no_valid_cage, "the cage that was made is not valid (" + summary(report) +
                                        "); try another --resolution or --depth"};
}

} // namespace

OrientedBox in_model_units(const UnitFrame& frame, const OrientedBox& box) {
  return {frame.from_unit(box.center), box.axes, box.half * frame.diagonal};
}

Result<BoxDecomposition> decompose(TriangleView model, const GenerateOptions& options,
                                   const Progress& progress) {
  if (const std::optional<Error> error = bad_option(options)) {
    return *error;
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
  const VoxelizeOptions voxels{.resolution = options.resolution};

  made.vertex_box = pca_box(positions);
  Result<VoxelGrid> first = voxelize(unit, made.vertex_box, voxels, progress.part(0, 0.4));
  if (!first) {
    return first.error();
  }
  made.point_box = pca_box(point_set(unit, *first));
  watch.lap("first voxels");

  Result<VoxelGrid> second = voxelize(unit, made.point_box, voxels, progress.part(0.4, 0.8));
  if (!second) {
    return second.error();
  }
  made.grid = std::move(*second);
  if (options.pieces == Pieces::together) {
    made.bridges = join_pieces(made.grid);
  }
  watch.lap("voxels");

  Result<BoxTree> tree = build_box_tree(made.grid, options.slicing, progress.part(0.8, 1));
  if (!tree) {
    return tree.error();
  }
  made.tree = std::move(*tree);
  watch.lap("slicing");
  return made;
}

Result<GeneratedCage> generate_cage(TriangleView model, const GenerateOptions& options,
                                    const Progress& progress) {
  Result<BoxDecomposition> boxes = decompose(model, options, progress.part(0, decomposed));
  if (!boxes) {
    return boxes.error();
  }
  GeneratedCage made;
  made.boxes = std::move(*boxes);
  made.times = made.boxes.times;
  made.leaves = made.boxes.tree.cover();
  Stopwatch watch(made.times);

  std::vector<BoxContents> contents;
  for (const int leaf : made.leaves) {
    const BoxNode& node = made.boxes.tree.nodes[static_cast<std::size_t>(leaf)];
    contents.push_back({node.box, node.voxels});
  }
  made.registration = options.registration ? register_boxes(made.boxes.grid, contents)
                                           : keep_apart(contents);
  watch.lap("registration");

  Result<TriangleMesh> cage =
      unite(to_model_units(made.boxes.frame, made.registration.solids),
            {.separation = separation * made.boxes.grid.size * made.boxes.frame.diagonal},
            progress.part(registered, united));
  if (!cage) {
    return cage.error();
  }
  made.cage = std::move(*cage);
  watch.lap("union");

  const Result<ValidityReport> report =
      validate_cage(made.cage, model, {.allow_pieces = options.pieces == Pieces::apart},
                    progress.part(united, 1));
  if (!report) {
    return report.error();
  }
  if (!report->valid()) {
    return not_valid(*report);
  }
  watch.lap("check");
  return made;
}

} // namespace cagewright
