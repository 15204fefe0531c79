#include <cagewright/coordinates/coordinates.h>

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <mutex>
#include <string>

namespace cagewright {

void PointCounts::add(const TileReport& report) {
  on_surface += static_cast<std::size_t>(std::popcount(report.on_surface));
  undefined += static_cast<std::size_t>(std::popcount(report.undefined));
  outside += static_cast<std::size_t>(std::popcount(report.outside));
}

void PointCounts::add(const PointCounts& other) {
  on_surface += other.on_surface;
  undefined += other.undefined;
  outside += other.outside;
}

TileReport Coordinates::solve_tile(std::span<const Vec3> points, std::span<float> weights,
                                   std::size_t stride) const {
  AlignedBuffer<double> exact(16 * columns());
  const TileReport report = solve_tile(points, exact.span(), 16);
  for (std::size_t k = 0; k < columns(); ++k) {
    for (std::size_t i = 0; i < 16; ++i) {
      weights[k * stride + i] = static_cast<float>(exact.data()[16 * k + i]);
    }
  }
  return report;
}

template <class T>
PointCounts solve_block(const Coordinates& coordinates, std::span<const Vec3> points,
                        std::span<T> weights, std::size_t stride) {
  assert(stride >= (points.size() + 15) / 16 * 16);
  PointCounts counts;
  for (std::size_t first = 0; first < points.size(); first += 16) {
    const std::size_t count = std::min<std::size_t>(16, points.size() - first);
    counts.add(coordinates.solve(points.subspan(first, count), weights.subspan(first), stride));
  }
  return counts;
}

template PointCounts solve_block(const Coordinates&, std::span<const Vec3>, std::span<double>,
                                 std::size_t);
template PointCounts solve_block(const Coordinates&, std::span<const Vec3>, std::span<float>,
                                 std::size_t);

Status accept(const Coordinates& coordinates, const PointCounts& counts) {
  if (counts.outside == 0 || coordinates.outside() != OutsideTreatment::error) {
    return success();
  }
  return Error{ErrorCode::invalid_cage,
               std::to_string(counts.outside) +
                   (counts.outside == 1 ? " point is" : " points are") +
                   " outside the cage, where these coordinates are not defined; mend the cage, or "
                   "say what should become of them ('outside')"};
}

template <class T>
Result<SolvedWeights<T>> solve_all(const Coordinates& coordinates, std::span<const Vec3> points,
                                   const Progress& progress) {
  SolvedWeights<T> solved{{points.size(), coordinates.columns()}, {}};
  std::mutex reporting;
  std::size_t finished = 0;
  // A few hundred microseconds between two looks at the stop token.
  constexpr std::size_t block = 128;
  constexpr std::size_t stride = WeightTiles<T>::tile_points;
  static_assert(stride % block == 0);
  const std::size_t blocks = (points.size() + block - 1) / block;
  parallel_for(0, blocks, 1, [&](std::size_t b) {
    if (progress.cancelled()) {
      return;
    }
    const std::size_t first = b * block;
    const PointCounts counts =
        solve_block(coordinates, points.subspan(first, std::min(block, points.size() - first)),
                    solved.weights.from(first), stride);
    const std::scoped_lock lock(reporting);
    solved.counts.add(counts);
    progress(static_cast<double>(++finished) / static_cast<double>(blocks), "bind");
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  if (Status status = accept(coordinates, solved.counts); !status) {
    return status.error();
  }
  solved.weights.fill_up();
  return solved;
}

template Result<SolvedWeights<double>> solve_all(const Coordinates&, std::span<const Vec3>,
                                                 const Progress&);
template Result<SolvedWeights<float>> solve_all(const Coordinates&, std::span<const Vec3>,
                                                const Progress&);

} // namespace cagewright
