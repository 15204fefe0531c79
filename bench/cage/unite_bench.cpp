#include "cage/register_boxes.h"
#include "cage/unite.h"

#include "mesh/shapes.h"
#include "obb/principal_axes.h"
#include "slicing/box_tree.h"
#include "voxel/voxelize.h"

#include <benchmark/benchmark.h>

#include <random>

namespace {

using namespace cagewright;

/// Limbs as of a character: each box starts at the end of an earlier one, at a random angle, and
/// overlaps it and two or three others.
std::vector<Hexahedron> limbs(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec3> ends = {Vec3::Zero()};
  std::vector<Hexahedron> boxes;
  while (boxes.size() < count) {
    const Vec3 start = ends[random() % ends.size()];
    const Vec3 way = Vec3(uniform(random), uniform(random), uniform(random)).normalized();
    const Mat3 axes = (Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), way) *
                       Eigen::AngleAxisd(3 * uniform(random), Vec3::UnitX()))
                          .toRotationMatrix();
    const Vec3 half(0.95, 0.35 + 0.1 * uniform(random), 0.35 + 0.1 * uniform(random));
    boxes.push_back(make_box(start + 0.75 * way, axes, half));
    ends.emplace_back(start + 1.5 * way);
  }
  return boxes;
}

void unite_limbs(benchmark::State& state) {
  const std::vector<Hexahedron> boxes = limbs(static_cast<std::size_t>(state.range(0)));
  std::size_t vertices = 0;
  for (auto _ : state) {
    vertices = unite(boxes)->positions.size();
  }
  state.counters["vertices"] = static_cast<double>(vertices);
}
BENCHMARK(unite_limbs)
    ->ArgName("boxes")
    ->Arg(8)
    ->Arg(16)
    ->Arg(32)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The boxes of a ring, which are joined all round.
void register_ring(benchmark::State& state) {
  const TriangleMesh torus = make_torus(0.35, 192, 96);
  const VoxelGrid grid = *voxelize(torus, pca_box(torus.positions), {.resolution = 64});
  const BoxTree tree = *build_box_tree(grid, {.depth = static_cast<int>(state.range(0))});
  std::vector<BoxContents> contents;
  for (const int leaf : tree.cover()) {
    const BoxNode& node = tree.nodes[static_cast<std::size_t>(leaf)];
    contents.push_back({node.box, node.voxels});
  }
  std::size_t joints = 0;
  for (auto _ : state) {
    joints = register_boxes(grid, contents)->joints.size();
  }
  state.counters["boxes"] = static_cast<double>(contents.size());
  state.counters["joints"] = static_cast<double>(joints);
}
BENCHMARK(register_ring)
    ->ArgName("depth")
    ->Arg(3)
    ->Arg(5)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
