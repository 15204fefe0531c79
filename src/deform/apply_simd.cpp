// Sums of weights times displacements for tiles of sixteen points, one point to a vector lane.
// Compiled once for each instruction set (Highway includes this file again and again). Memory is
// the limit, so that accumulating in double costs nothing.

#include "deform/apply.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deform/apply_simd.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef CAGEWRIGHT_DEFORM_TILE_MOVES
#define CAGEWRIGHT_DEFORM_TILE_MOVES
namespace cagewright {
namespace {

/// The displaced cage vertices.
struct Moves {
  std::span<const Index> cage_vertices;
  std::span<const Vec3> displacements;
  std::span<const double> steps = {}; // of compact weights, for all of the cage's vertices
};

/// Where sixteen points come from and go to: x, y and z of each, as Vec3 has them.
struct TilePoints {
  const double* base;
  double* positions;
};

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
// As many points at once as leave the sums in registers, of which AVX2 has sixteen.
constexpr std::size_t vectors = std::min<std::size_t>(16 / lanes, 4);

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

/// Moves the points first, first + 1... of a tile, as many as `vectors` registers hold. \returns
/// the greatest change of each coordinate.
template <class T>
HWY_INLINE V move_points_from(const T* tile, std::size_t tile_size, std::size_t first,
                              const Moves& moves, const TilePoints& points) {
  const D d;
  V x[vectors];
  V y[vectors];
  V z[vectors];
  for (std::size_t i = 0; i < vectors; ++i) {
    x[i] = y[i] = z[i] = hn::Zero(d);
  }
  for (std::size_t k = 0; k < moves.cage_vertices.size(); ++k) {
    const T* weights = tile + std::size_t(moves.cage_vertices[k]) * 16 + first;
    // The same vertex in the next tile. With few vertices moved the processor does not see the
    // pattern by itself; beyond the last tile nothing happens.
    hwy::Prefetch(weights + tile_size);
    Vec3 by = moves.displacements[k];
    if constexpr (std::is_integral_v<T>) {
      by *= moves.steps[moves.cage_vertices[k]];
    }
    const V by_x = hn::Set(d, by.x());
    const V by_y = hn::Set(d, by.y());
    const V by_z = hn::Set(d, by.z());
    for (std::size_t i = 0; i < vectors; ++i) {
      const V w = load(d, weights + i * lanes);
      x[i] = hn::MulAdd(w, by_x, x[i]);
      y[i] = hn::MulAdd(w, by_y, y[i]);
      z[i] = hn::MulAdd(w, by_z, z[i]);
    }
  }
  V change = hn::Zero(d);
  alignas(64) double offsets[3 * vectors * lanes];
  for (std::size_t i = 0; i < vectors; ++i) {
    hn::StoreInterleaved3(x[i], y[i], z[i], d, offsets + 3 * i * lanes);
  }
  for (std::size_t i = 0; i < 3 * vectors * lanes; i += lanes) {
    double* const position = points.positions + 3 * first + i;
    const V before = hn::LoadU(d, position);
    const V after = hn::Add(hn::LoadU(d, points.base + 3 * first + i), hn::Load(d, offsets + i));
    change = hn::Max(change, hn::Abs(hn::Sub(after, before)));
    hn::StoreU(after, d, position);
  }
  return change;
}

template <class T>
double move_any(const T* tile, std::size_t tile_size, const Moves& moves,
                const TilePoints& points) {
  for (std::size_t i = 48; i < 96; i += 8) { // the points of the next tile
    hwy::Prefetch(points.base + i);
    hwy::Prefetch(points.positions + i);
  }
  V change = hn::Zero(D());
  for (std::size_t first = 0; first < 16; first += vectors * lanes) {
    change = hn::Max(change, move_points_from(tile, tile_size, first, moves, points));
  }
  return hn::GetLane(hn::MaxOfLanes(D(), change));
}

double move_double(const double* tile, std::size_t size, const Moves& moves,
                   const TilePoints& points) {
  return move_any(tile, size, moves, points);
}
double move_float(const float* tile, std::size_t size, const Moves& moves,
                  const TilePoints& points) {
  return move_any(tile, size, moves, points);
}
double move_fixed(const std::int16_t* tile, std::size_t size, const Moves& moves,
                  const TilePoints& points) {
  return move_any(tile, size, moves, points);
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
double move_whole(std::span<const double> tile, const Moves& moves, const TilePoints& points) {
  return HWY_DYNAMIC_DISPATCH(move_double)(tile.data(), tile.size(), moves, points);
}
double move_whole(std::span<const float> tile, const Moves& moves, const TilePoints& points) {
  return HWY_DYNAMIC_DISPATCH(move_float)(tile.data(), tile.size(), moves, points);
}
double move_whole(std::span<const std::int16_t> tile, const Moves& moves,
                  const TilePoints& points) {
  return HWY_DYNAMIC_DISPATCH(move_fixed)(tile.data(), tile.size(), moves, points);
}

/// Up to 16 points; a tile that is not full goes through a full one.
template <class T>
double move_part(std::span<const T> tile, const Moves& moves, std::span<const Vec3> base,
                 std::span<Vec3> positions) {
  if (positions.size() == 16) {
    return move_whole(tile, moves, {base.data()->data(), positions.data()->data()});
  }
  std::array<Vec3, 16> from;
  std::array<Vec3, 16> to;
  from.fill(Vec3::Zero());
  to.fill(Vec3::Zero());
  std::ranges::copy(base, from.begin());
  std::ranges::copy(positions, to.begin());
  const double change = move_whole(tile, moves, {from[0].data(), to[0].data()});
  std::copy_n(to.begin(), positions.size(), positions.begin());
  return change;
}

} // namespace

namespace {

template <class T, class StepsOf>
void move_all(const WeightTiles<T>& weights, const Moves& moves, std::span<const Vec3> base,
              std::span<Vec3> positions, std::span<double> moved, const StepsOf& steps_of) {
  assert(moves.cage_vertices.size() == moves.displacements.size());
  assert(base.size() == weights.points() && positions.size() == weights.points());
  assert(moved.empty() || moved.size() == weights.tile_count());
  parallel_for(0, weights.tile_count(), 64, [&](std::size_t t) {
    const std::size_t first = t * 16;
    const std::size_t count = std::min<std::size_t>(16, weights.points() - first);
    const double change =
        move_part(weights.tile(t), {moves.cage_vertices, moves.displacements, steps_of(t)},
                  base.subspan(first, count), positions.subspan(first, count));
    if (!moved.empty()) {
      moved[t] += change;
    }
  });
}

} // namespace

template <class T>
void move_points(const WeightTiles<T>& weights, std::span<const Index> cage_vertices,
                 std::span<const Vec3> displacements, std::span<const Vec3> base,
                 std::span<Vec3> positions, std::span<double> moved) {
  move_all(weights, {cage_vertices, displacements}, base, positions, moved,
           [](std::size_t) { return std::span<const double>(); });
}

template void move_points(const WeightTiles<double>&, std::span<const Index>, std::span<const Vec3>,
                          std::span<const Vec3>, std::span<Vec3>, std::span<double>);
template void move_points(const WeightTiles<float>&, std::span<const Index>, std::span<const Vec3>,
                          std::span<const Vec3>, std::span<Vec3>, std::span<double>);

void move_points(const CompactWeights& weights, std::span<const Index> cage_vertices,
                 std::span<const Vec3> displacements, std::span<const Vec3> base,
                 std::span<Vec3> positions, std::span<double> moved) {
  move_all(weights.tiles, {cage_vertices, displacements}, base, positions, moved,
           [&](std::size_t tile) { return weights.steps_of_tile(tile); });
}

template <class T>
void move_tile(std::span<const T> tile, std::span<const Index> cage_vertices,
               std::span<const Vec3> displacements, std::span<const Vec3> base,
               std::span<Vec3> positions) {
  move_part(tile, {cage_vertices, displacements}, base, positions);
}

template void move_tile(std::span<const double>, std::span<const Index>, std::span<const Vec3>,
                        std::span<const Vec3>, std::span<Vec3>);

} // namespace cagewright
#endif
