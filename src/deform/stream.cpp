#include <cagewright/deform/stream.h>

#include "core/parallel.h"
#include "deform/apply.h"

#include <algorithm>
#include <mutex>

namespace cagewright {

Result<StreamedPoses> deform_streaming(const Coordinates& coordinates,
                                       std::span<const std::vector<Vec3>> poses,
                                       std::span<const Vec3> points, const Progress& progress) {
  constexpr std::size_t block = 128; // between two looks at the stop token
  const std::size_t blocks = (points.size() + block - 1) / block;
  std::vector<PosedColumns> posed;
  StreamedPoses result;
  for (const std::vector<Vec3>& pose : poses) {
    posed.emplace_back(*coordinates.rule(), pose);
    result.positions.emplace_back(points.begin(), points.end());
  }
  std::mutex reporting;
  std::size_t finished = 0;
  parallel_for(0, blocks, 1, [&](std::size_t b) {
    if (progress.cancelled()) {
      return;
    }
    AlignedBuffer<double> weights(16 * coordinates.columns());
    PointCounts counts;
    const std::size_t end = std::min((b + 1) * block, points.size());
    for (std::size_t first = b * block; first < end; first += 16) {
      const std::size_t count = std::min<std::size_t>(16, end - first);
      counts.add(coordinates.solve(points.subspan(first, count), weights.span()));
      for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        move_sixteen(weights.span(), posed[pose], points.subspan(first, count),
                     std::span(result.positions[pose]).subspan(first, count));
      }
    }
    const std::scoped_lock lock(reporting);
    result.counts.add(counts);
    progress(static_cast<double>(++finished) / static_cast<double>(blocks), "deform");
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  if (Status status = accept(coordinates, result.counts); !status) {
    return status.error();
  }
  return result;
}

} // namespace cagewright
