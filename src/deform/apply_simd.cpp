// Sums of weights times displacements. Compiled once for each instruction set (Highway includes
// this file again and again). Memory is the limit, so that accumulating in double costs nothing.
//
// Columns are taken four at a time, so that memory is read in long runs: the runs of four of
// them in a tile, side by side. The sums of the tile's points wait meanwhile in the nearest cache.

#include "deform/apply.h"

#include "core/parallel.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deform/apply_simd.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef CAGEWRIGHT_DEFORM_TILE_MOVES
#define CAGEWRIGHT_DEFORM_TILE_MOVES
namespace cagewright {
namespace {

/// The columns that move.
struct Moves {
  std::span<const Index> columns;
  std::span<const Vec3> by;
  std::span<const double> steps = {}; // of compact weights, for all columns
};

/// The weights of some points: those for column k begin at first[k * stride].
template <class T> struct WeightsIn {
  const T* first;
  const T* next; ///< those of the points after these, to be fetched ahead; or the same again
  std::size_t stride;
};

/// Where points come from and go to.
struct TilePoints {
  std::span<const Vec3> base;
  std::span<Vec3> positions;
  double* moved; ///< for each 16 points, or null
};

constexpr std::size_t most_points = FloatWeights::tile_points;

} // namespace
} // namespace cagewright
#endif

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 16>;
using V = hn::VFromD<D>;
constexpr std::size_t lanes = hn::MaxLanes(D());
constexpr std::size_t most_columns = 4;

HWY_INLINE V load(D d, const double* from) {
  return hn::LoadU(d, from);
}
HWY_INLINE V load(D d, const float* from) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), from));
}
HWY_INLINE V load(D d, const std::int16_t* from) {
  const hn::Rebind<std::int32_t, D> wide;
  return hn::PromoteTo(d, hn::PromoteTo(wide, hn::LoadU(hn::Rebind<std::int16_t, D>(), from)));
}

/// A few columns: their weights, those to be fetched ahead, and how far they move.
template <class T> struct Columns {
  std::array<const T*, most_columns> weights;
  std::array<const T*, most_columns> ahead;
  std::array<Vec3, most_columns> by;
};

/// Sixteen points: the sums as x, y and z of each, as Vec3 has them, are added to the base.
HWY_INLINE double finish(const double* offsets, const double* base, double* positions) {
  const D d;
  V change = hn::Zero(d);
  for (std::size_t i = 0; i < 48; i += lanes) {
    const V before = hn::LoadU(d, positions + i);
    const V after = hn::Add(hn::LoadU(d, base + i), hn::Load(d, offsets + i));
    change = hn::Max(change, hn::Abs(hn::Sub(after, before)));
    hn::StoreU(after, d, positions + i);
  }
  return hn::GetLane(hn::MaxOfLanes(d, change));
}

/// The same for the last points of a model, which are fewer.
double finish_some(const double* offsets, std::span<const Vec3> base, std::span<Vec3> positions) {
  alignas(64) std::array<double, 48> from{};
  alignas(64) std::array<double, 48> to{};
  for (std::size_t i = 0; i < 3 * base.size(); ++i) {
    from[i] = base[i / 3][static_cast<Eigen::Index>(i % 3)];
    to[i] = positions[i / 3][static_cast<Eigen::Index>(i % 3)];
  }
  const double change = finish(offsets, from.data(), to.data());
  for (std::size_t i = 0; i < 3 * base.size(); ++i) {
    positions[i / 3][static_cast<Eigen::Index>(i % 3)] = to[i];
  }
  return change;
}

void finish_points(std::size_t first, const double* offsets, const TilePoints& points) {
  const std::size_t left = points.base.size() - first;
  double change = 0;
  if (left >= 16) {
    const double* const base = points.base[first].data();
    double* const positions = points.positions[first].data();
    for (std::size_t i = 0; i < 48; i += 8) { // some lines ahead; beyond the end nothing happens
      hwy::Prefetch(base + 192 + i);
      hwy::Prefetch(positions + 192 + i);
    }
    change = finish(offsets, base, positions);
  } else {
    change = finish_some(offsets, points.base.subspan(first), points.positions.subspan(first));
  }
  if (points.moved != nullptr) {
    points.moved[first / 16] += change;
  }
}

/// Adds what `count` columns contribute to the sums of all points of a tile: 16 x, 16 y and
/// 16 z for each 16 points. The first columns start the sums, the last ones finish the
/// points.
template <std::size_t count, class T>
void add_columns(const Columns<T>& columns, bool is_first, bool is_last, double* sums,
                 const TilePoints& points) {
  const D d;
  V x_by[count];
  V y_by[count];
  V z_by[count];
  for (std::size_t k = 0; k < count; ++k) {
    x_by[k] = hn::Set(d, columns.by[k].x());
    y_by[k] = hn::Set(d, columns.by[k].y());
    z_by[k] = hn::Set(d, columns.by[k].z());
  }
  for (std::size_t first = 0; first < points.base.size(); first += 16) {
    for (std::size_t k = 0; k < most_columns; ++k) {
      for (std::size_t i = 0; i < 16; i += 64 / sizeof(T)) {
        hwy::Prefetch(columns.ahead[k] + first + i);
      }
    }
    double* const sum = sums + 3 * first;
    alignas(64) double offsets[48];
    for (std::size_t i = 0; i < 16; i += lanes) {
      V x = is_first ? hn::Zero(d) : hn::Load(d, sum + i);
      V y = is_first ? hn::Zero(d) : hn::Load(d, sum + 16 + i);
      V z = is_first ? hn::Zero(d) : hn::Load(d, sum + 32 + i);
      for (std::size_t k = 0; k < count; ++k) {
        const V w = load(d, columns.weights[k] + first + i);
        x = hn::MulAdd(w, x_by[k], x);
        y = hn::MulAdd(w, y_by[k], y);
        z = hn::MulAdd(w, z_by[k], z);
      }
      if (is_last) {
        hn::StoreInterleaved3(x, y, z, d, offsets + 3 * i);
      } else {
        hn::Store(x, d, sum + i);
        hn::Store(y, d, sum + 16 + i);
        hn::Store(z, d, sum + 32 + i);
      }
    }
    if (is_last) {
      finish_points(first, offsets, points);
    }
  }
}

template <class T>
void move_any(const WeightsIn<T>& weights, const Moves& moves, const TilePoints& points) {
  alignas(64) std::array<double, 3 * most_points> sums;
  const std::size_t total = moves.columns.size();
  for (std::size_t begin = 0; begin < total; begin += most_columns) {
    const std::size_t end = std::min(begin + most_columns, total);
    const bool is_first = begin == 0;
    const bool is_last = end == total;
    Columns<T> columns;
    for (std::size_t k = 0; k < most_columns; ++k) {
      const std::size_t here = std::min(begin + k, end - 1);
      const std::size_t column = moves.columns[here];
      columns.weights[k] = weights.first + column * weights.stride;
      columns.by[k] = moves.by[here];
      if constexpr (std::is_integral_v<T>) {
        columns.by[k] *= moves.steps[column];
      }
      // The next columns, or the first ones of the next points.
      const std::size_t there = is_last ? std::min(k, total - 1) : std::min(end + k, total - 1);
      columns.ahead[k] =
          (is_last ? weights.next : weights.first) + moves.columns[there] * weights.stride;
    }
    switch (end - begin) {
    case 4:
      add_columns<4>(columns, is_first, is_last, sums.data(), points);
      break;
    case 3:
      add_columns<3>(columns, is_first, is_last, sums.data(), points);
      break;
    case 2:
      add_columns<2>(columns, is_first, is_last, sums.data(), points);
      break;
    default:
      add_columns<1>(columns, is_first, is_last, sums.data(), points);
    }
  }
}

void move_double(const WeightsIn<double>& weights, const Moves& moves, const TilePoints& points) {
  move_any(weights, moves, points);
}
void move_float(const WeightsIn<float>& weights, const Moves& moves, const TilePoints& points) {
  move_any(weights, moves, points);
}
void move_fixed(const WeightsIn<std::int16_t>& weights, const Moves& moves,
                const TilePoints& points) {
  move_any(weights, moves, points);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(move_double);
HWY_EXPORT(move_float);
HWY_EXPORT(move_fixed);

namespace {

// The overloads choose by the type of the weights, and each by the machine.
void move_some(const WeightsIn<double>& weights, const Moves& moves, const TilePoints& points) {
  HWY_DYNAMIC_DISPATCH(move_double)(weights, moves, points);
}
void move_some(const WeightsIn<float>& weights, const Moves& moves, const TilePoints& points) {
  HWY_DYNAMIC_DISPATCH(move_float)(weights, moves, points);
}
void move_some(const WeightsIn<std::int16_t>& weights, const Moves& moves,
               const TilePoints& points) {
  HWY_DYNAMIC_DISPATCH(move_fixed)(weights, moves, points);
}

/// Nothing but the base moves the points.
void copy_all(std::span<const Vec3> base, std::span<Vec3> positions, std::span<double> moved) {
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (!moved.empty()) {
      const double change = (base[i] - positions[i]).cwiseAbs().maxCoeff();
      moved[i / 16] = std::max(moved[i / 16], change);
    }
    positions[i] = base[i];
  }
}

template <class T, class StepsOf>
void move_all(const WeightTiles<T>& weights, const Moves& moves, std::span<const Vec3> base,
              std::span<Vec3> positions, std::span<double> moved, const StepsOf& steps_of) {
  constexpr std::size_t tile_points = WeightTiles<T>::tile_points;
  assert(moves.columns.size() == moves.by.size());
  assert(base.size() == weights.points() && positions.size() == weights.points());
  assert(moved.empty() || moved.size() == (weights.points() + 15) / 16);
  if (moves.columns.empty()) {
    copy_all(base, positions, moved);
    return;
  }
  parallel_for(0, weights.tile_count(), 2, [&](std::size_t t) {
    const std::size_t first = t * tile_points;
    const std::size_t count = std::min(tile_points, weights.points() - first);
    const std::size_t next = std::min(t + 1, weights.tile_count() - 1);
    move_some(WeightsIn<T>{weights.tile(t).data(), weights.tile(next).data(), tile_points},
              {moves.columns, moves.by, steps_of(t)},
              {base.subspan(first, count), positions.subspan(first, count),
               moved.empty() ? nullptr : moved.data() + first / 16});
  });
}

} // namespace

template <class T>
void move_points(const WeightTiles<T>& weights, std::span<const Index> columns,
                 std::span<const Vec3> moves, std::span<const Vec3> base, std::span<Vec3> positions,
                 std::span<double> moved) {
  move_all(weights, {columns, moves}, base, positions, moved,
           [](std::size_t) { return std::span<const double>(); });
}

template void move_points(const WeightTiles<double>&, std::span<const Index>, std::span<const Vec3>,
                          std::span<const Vec3>, std::span<Vec3>, std::span<double>);
template void move_points(const WeightTiles<float>&, std::span<const Index>, std::span<const Vec3>,
                          std::span<const Vec3>, std::span<Vec3>, std::span<double>);

void move_points(const CompactWeights& weights, std::span<const Index> columns,
                 std::span<const Vec3> moves, std::span<const Vec3> base, std::span<Vec3> positions,
                 std::span<double> moved) {
  move_all(weights.tiles, {columns, moves}, base, positions, moved,
           [&](std::size_t tile) { return weights.steps_of_tile(tile); });
}

PosedColumns::PosedColumns(const ColumnRule& rule, std::span<const Vec3> cage)
    : columns(rule.columns()), moves(columns.size()), divisor(rule.divisor(cage)) {
  std::iota(columns.begin(), columns.end(), Index(0));
  rule.move(cage, moves);
}

void divide_points(const Vec3& center, const std::array<std::span<const Vec3>, 3>& by,
                   std::span<Vec3> positions) {
  parallel_for(0, positions.size(), 256, [&](std::size_t i) {
    Mat3 matrix = Mat3::Identity();
    for (Eigen::Index a = 0; a < 3; ++a) {
      matrix.col(a) += by[static_cast<std::size_t>(a)][i];
    }
    positions[i] = center + matrix.partialPivLu().solve(positions[i] - center);
  });
}

void move_sixteen(std::span<const double> weights, const PosedColumns& pose,
                  std::span<const Vec3> rest, std::span<Vec3> positions) {
  assert(rest.size() <= 16 && positions.size() == rest.size());
  const auto move = [&](std::span<const Vec3> by, std::span<const Vec3> base, std::span<Vec3> to) {
    move_some(WeightsIn<double>{weights.data(), weights.data(), 16}, {pose.columns, by},
              {base, to, nullptr});
  };
  move(pose.moves, rest, positions);
  if (pose.divisor) {
    std::array<std::array<Vec3, 16>, 3> by;
    for (std::size_t a = 0; a < 3; ++a) {
      by[a].fill(Vec3::Zero());
      const std::span<Vec3> some = std::span(by[a]).first(rest.size());
      move(pose.divisor->moves[a], some, some);
    }
    divide_points(pose.divisor->center, {by[0], by[1], by[2]}, positions);
  }
}

} // namespace cagewright
#endif
