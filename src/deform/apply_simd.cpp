// Sums of weights times displacements for tiles of sixteen points, one point to a vector lane.
// Compiled once for each instruction set (Highway includes this file again and again). Memory is
// the limit, so that accumulating in double costs nothing.

#include "deform/apply.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deform/apply_simd.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef CAGEWRIGHT_DEFORM_TILE_SUM
#define CAGEWRIGHT_DEFORM_TILE_SUM
namespace cagewright {
namespace {

/// What a tile is moved by: x, y and z of sixteen points.
struct TileSum {
  alignas(64) std::array<std::array<double, 16>, 3> offset;
};

/// The displaced cage vertices.
struct Moves {
  std::span<const Index> cage_vertices;
  std::span<const Vec3> displacements;
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

template <class T>
void sum_points(const T* tile, std::size_t first, const Moves& moves, TileSum& sum) {
  const D d;
  V x[vectors];
  V y[vectors];
  V z[vectors];
  for (std::size_t i = 0; i < vectors; ++i) {
    x[i] = y[i] = z[i] = hn::Zero(d);
  }
  for (std::size_t k = 0; k < moves.cage_vertices.size(); ++k) {
    const T* weights = tile + std::size_t(moves.cage_vertices[k]) * 16 + first;
    const Vec3& by = moves.displacements[k];
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
  for (std::size_t i = 0; i < vectors; ++i) {
    hn::Store(x[i], d, sum.offset[0].data() + first + i * lanes);
    hn::Store(y[i], d, sum.offset[1].data() + first + i * lanes);
    hn::Store(z[i], d, sum.offset[2].data() + first + i * lanes);
  }
}

template <class T> void sum_tile(const T* tile, const Moves& moves, TileSum& sum) {
  for (std::size_t first = 0; first < 16; first += vectors * lanes) {
    sum_points(tile, first, moves, sum);
  }
}

void sum_double(const double* tile, const Moves& moves, TileSum& sum) {
  sum_tile(tile, moves, sum);
}
void sum_float(const float* tile, const Moves& moves, TileSum& sum) {
  sum_tile(tile, moves, sum);
}
void sum_fixed(const std::int16_t* tile, const Moves& moves, TileSum& sum) {
  sum_tile(tile, moves, sum);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(sum_double);
HWY_EXPORT(sum_float);
HWY_EXPORT(sum_fixed);

namespace {

void sum_of(const double* tile, const Moves& moves, TileSum& sum) {
  HWY_DYNAMIC_DISPATCH(sum_double)(tile, moves, sum);
}
void sum_of(const float* tile, const Moves& moves, TileSum& sum) {
  HWY_DYNAMIC_DISPATCH(sum_float)(tile, moves, sum);
}
void sum_of(const std::int16_t* tile, const Moves& moves, TileSum& sum) {
  HWY_DYNAMIC_DISPATCH(sum_fixed)(tile, moves, sum);
}

/// positions = base + sum. \returns the greatest change of a coordinate.
double add(const TileSum& sum, std::span<const Vec3> base, std::span<Vec3> positions) {
  double change = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 moved = base[i] + Vec3(sum.offset[0][i], sum.offset[1][i], sum.offset[2][i]);
    change = std::max(change, (moved - positions[i]).cwiseAbs().maxCoeff());
    positions[i] = moved;
  }
  return change;
}

} // namespace

template <class T>
void move_points(const WeightTiles<T>& weights, std::span<const Index> cage_vertices,
                 std::span<const Vec3> displacements, std::span<const Vec3> base,
                 std::span<Vec3> positions, std::span<double> moved) {
  assert(cage_vertices.size() == displacements.size());
  assert(base.size() == weights.points() && positions.size() == weights.points());
  assert(moved.empty() || moved.size() == weights.tile_count());
  const Moves moves{cage_vertices, displacements};
  parallel_for(0, weights.tile_count(), 64, [&](std::size_t t) {
    TileSum sum;
    sum_of(weights.tile(t).data(), moves, sum);
    const std::size_t first = t * 16;
    const std::size_t count = std::min<std::size_t>(16, weights.points() - first);
    const double change = add(sum, base.subspan(first, count), positions.subspan(first, count));
    if (!moved.empty()) {
      moved[t] += change;
    }
  });
}

template void move_points(const WeightTiles<double>&, std::span<const Index>, std::span<const Vec3>,
                          std::span<const Vec3>, std::span<Vec3>, std::span<double>);
template void move_points(const WeightTiles<float>&, std::span<const Index>, std::span<const Vec3>,
                          std::span<const Vec3>, std::span<Vec3>, std::span<double>);
template void move_points(const WeightTiles<std::int16_t>&, std::span<const Index>,
                          std::span<const Vec3>, std::span<const Vec3>, std::span<Vec3>,
                          std::span<double>);

template <class T>
void move_tile(std::span<const T> tile, std::span<const Index> cage_vertices,
               std::span<const Vec3> displacements, std::span<const Vec3> base,
               std::span<Vec3> positions) {
  TileSum sum;
  sum_of(tile.data(), Moves{cage_vertices, displacements}, sum);
  add(sum, base, positions);
}

template void move_tile(std::span<const double>, std::span<const Index>, std::span<const Vec3>,
                        std::span<const Vec3>, std::span<Vec3>);

} // namespace cagewright
#endif
