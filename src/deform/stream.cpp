#include <cagewright/deform/stream.h>

#include "core/parallel.h"
#include "deform/apply.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <mutex>
#include <numeric>

namespace cagewright {
namespace {

std::vector<Vec3> differences(std::span<const Vec3> to, std::span<const Vec3> from) {
  assert(to.size() == from.size());
  std::vector<Vec3> result(to.begin(), to.end());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] -= from[i];
  }
  return result;
}

} // namespace

Result<StreamedPoses> deform_streaming(const MeanValueSolver& solver, std::span<const Vec3> rest,
                                       std::span<const std::vector<Vec3>> poses,
                                       std::span<const Vec3> points, const Progress& progress) {
  constexpr std::size_t block = 128; // between two looks at the stop token
  const std::size_t blocks = (points.size() + block - 1) / block;
  std::vector<Index> all(solver.cage_vertices());
  std::iota(all.begin(), all.end(), Index(0));
  std::vector<std::vector<Vec3>> displacements;
  StreamedPoses result;
  for (const std::vector<Vec3>& pose : poses) {
    displacements.push_back(differences(pose, rest));
    result.positions.emplace_back(points.begin(), points.end());
  }
  std::mutex reporting;
  std::size_t finished = 0;
  parallel_for(0, blocks, 1, [&](std::size_t b) {
    if (progress.cancelled()) {
      return;
    }
    AlignedBuffer<double> weights(16 * all.size());
    int on_surface = 0;
    int undefined = 0;
    const std::size_t end = std::min((b + 1) * block, points.size());
    for (std::size_t first = b * block; first < end; first += 16) {
      const std::size_t count = std::min<std::size_t>(16, end - first);
      const TileReport report = solver.solve(points.subspan(first, count), weights.span());
      on_surface += std::popcount(report.on_surface);
      undefined += std::popcount(report.undefined);
      for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        move_sixteen(weights.span(), all, displacements[pose], points.subspan(first, count),
                     std::span(result.positions[pose]).subspan(first, count));
      }
    }
    const std::scoped_lock lock(reporting);
    result.on_surface += static_cast<std::size_t>(on_surface);
    result.undefined += static_cast<std::size_t>(undefined);
    progress(static_cast<double>(++finished) / static_cast<double>(blocks), "deform");
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  return result;
}

} // namespace cagewright
