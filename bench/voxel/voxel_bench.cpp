// Voxels of a bumpy ball, closed or with a tenth of its faces missing.
#include "core/random.h"
#include "mesh/shapes.h"
#include "obb/principal_axes.h"
#include "voxel/bridge.h"
#include "voxel/classify.h"
#include "voxel/grid_components.h"
#include "voxel/point_set.h"
#include "voxel/surface_patches.h"
#include "voxel/voxelize.h"

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <cmath>

namespace cagewright {
namespace {

// 81,920 triangles with 6 subdivisions, 20,480 with 5.
TriangleMesh bumpy_ball(int subdivisions, bool open) {
  TriangleMesh ball = make_icosphere(subdivisions);
  for (Vec3& p : ball.positions) {
    p *= 1 + 0.2 * std::sin(9 * p.x()) * std::sin(8 * p.y()) * std::sin(7 * p.z());
  }
  if (open) {
    Random random(1);
    std::erase_if(ball.triangles, [&](const Triangle&) { return random.uniform() < 0.1; });
  }
  return ball;
}

void voxelize_ball(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_ball(6, state.range(2) != 0);
  const OrientedBox frame = pca_box(mesh.positions);
  tbb::task_arena arena(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    arena.execute([&] {
      benchmark::DoNotOptimize(
          voxelize(mesh, frame, {.resolution = static_cast<int>(state.range(0))}));
    });
  }
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
}

void classify_ball(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_ball(6, state.range(0) != 0);
  const auto grid = voxelize(mesh, pca_box(mesh.positions));
  for (auto _ : state) {
    VoxelGrid copy = *grid;
    benchmark::DoNotOptimize(classify(mesh, copy));
  }
}

void surface_patches_of(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_ball(6, false);
  for (auto _ : state) {
    benchmark::DoNotOptimize(surface_patches(mesh));
  }
}

void point_set_of(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_ball(5, false);
  const auto grid = voxelize(mesh, pca_box(mesh.positions));
  for (auto _ : state) {
    benchmark::DoNotOptimize(point_set(mesh, *grid));
  }
}

void grid_components_of(benchmark::State& state) {
  const TriangleMesh mesh = bumpy_ball(5, false);
  const auto grid = voxelize(mesh, pca_box(mesh.positions));
  for (auto _ : state) {
    benchmark::DoNotOptimize(grid_components(*grid));
  }
}

void join_scattered_pieces(benchmark::State& state) {
  VoxelGrid grid;
  grid.dims = {66, 66, 66};
  grid.kinds.assign(66U * 66 * 66, VoxelKind::outer);
  Random random(1);
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    grid.kinds[random.below(grid.kinds.size())] = VoxelKind::feature;
  }
  for (auto _ : state) {
    VoxelGrid copy = grid;
    benchmark::DoNotOptimize(join_pieces(copy));
  }
}

BENCHMARK(voxelize_ball)
    ->ArgNames({"resolution", "threads", "open"})
    ->ArgsProduct({{64, 128}, {1, 2}, {0, 1}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(classify_ball)
    ->ArgName("open")
    ->Arg(0)
    ->Arg(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(surface_patches_of)->Unit(benchmark::kMillisecond);
BENCHMARK(point_set_of)->Unit(benchmark::kMillisecond);
BENCHMARK(grid_components_of)->Unit(benchmark::kMillisecond);
BENCHMARK(join_scattered_pieces)->Arg(100)->Arg(3000)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace cagewright
