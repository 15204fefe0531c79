#include "slicing/box_tree.h"

#include "mesh/shapes.h"
#include "obb/principal_axes.h"
#include "slicing/volume_rule.h"
#include "voxel/voxelize.h"

#include <benchmark/benchmark.h>

namespace {

using namespace cagewright;

/// A thick ring in a grid of the given resolution: about the share of occupied voxels, and the
/// number of parts, that a character has.
VoxelGrid ring(int resolution) {
  const TriangleMesh torus = make_torus(0.35, 192, 96);
  return *voxelize(torus, pca_box(torus.positions), {.resolution = resolution});
}

void cross_sections_of_the_root(benchmark::State& state) {
  const VoxelGrid grid = ring(static_cast<int>(state.range(0)));
  const BoxTree tree = *build_box_tree(grid, {.depth = 0});
  VoxelOwners owners{std::vector<std::uint32_t>(grid.kinds.size(), VoxelOwners::none),
                     std::vector<std::uint32_t>(grid.kinds.size(), 0)};
  owners.assign(tree.nodes[0].voxels, 0);
  for (auto _ : state) {
    for (int axis = 0; axis < 3; ++axis) {
      benchmark::DoNotOptimize(cross_section(grid, owners, 0, tree.nodes[0].box, axis));
    }
  }
}
BENCHMARK(cross_sections_of_the_root)
    ->ArgName("resolution")
    ->Arg(32)
    ->Arg(64)
    ->Arg(128)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void build_tree(benchmark::State& state, SlicingRule rule) {
  const VoxelGrid grid = ring(static_cast<int>(state.range(0)));
  std::size_t boxes = 0;
  for (auto _ : state) {
    const BoxTree tree =
        *build_box_tree(grid, {.rule = rule, .depth = static_cast<int>(state.range(1))});
    boxes = tree.cover().size();
  }
  state.counters["boxes"] = static_cast<double>(boxes);
}
BENCHMARK_CAPTURE(build_tree, volume, SlicingRule::volume)
    ->ArgNames({"resolution", "depth"})
    ->Args({64, 3})
    ->Args({64, 5})
    ->Args({128, 5})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(build_tree, published, SlicingRule::published)
    ->ArgNames({"resolution", "depth"})
    ->Args({64, 3})
    ->Args({64, 5})
    ->Args({128, 5})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
