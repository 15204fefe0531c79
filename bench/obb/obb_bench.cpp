// Oriented boxes of points evenly spread in a ball, as the centers of voxels are.
#include "core/random.h"
#include "obb/minimum_box.h"
#include "obb/principal_axes.h"

#include <benchmark/benchmark.h>

namespace cagewright {
namespace {

std::vector<Vec3> points_in_ball(std::int64_t count) {
  Random random(1);
  std::vector<Vec3> points;
  while (static_cast<std::int64_t>(points.size()) < count) {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const Vec3 p(x, y, random.uniform(-1, 1));
    if (p.norm() < 1) {
      points.push_back(p.cwiseProduct(Vec3(3, 2, 1)));
    }
  }
  return points;
}

void pca_box_of(benchmark::State& state) {
  const std::vector<Vec3> points = points_in_ball(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(pca_box(points));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void minimum_box_of(benchmark::State& state) {
  const std::vector<Vec3> points = points_in_ball(state.range(0));
  const MinimumBoxOptions options{.extra_starts = static_cast<int>(state.range(1))};
  double ratio = 0;
  for (auto _ : state) {
    ratio = minimum_box(points, options).volume() / pca_box(points).volume();
  }
  state.counters["of_pca_volume"] = ratio;
}

BENCHMARK(pca_box_of)->Arg(2000)->Arg(100000);
BENCHMARK(minimum_box_of)
    ->ArgNames({"points", "starts"})
    ->ArgsProduct({{2000, 10000}, {0, 8, 100}})
    ->Unit(benchmark::kMicrosecond);

} // namespace
} // namespace cagewright
