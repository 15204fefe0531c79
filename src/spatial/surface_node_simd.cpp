// Eight boxes at a time. Compiled once for each instruction set (Highway includes this file again
// and again); the best is chosen when the program runs. Nothing is fused: all of them give the same
// numbers.

#include "spatial/surface_node.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spatial/surface_node_simd.cpp"
// AVX-512 has nothing to add to eight lanes.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, SurfaceNode::width>;
using V = hn::Vec<D>;
constexpr D d_;

HWY_INLINE V load(const SurfaceNode::Lanes& lanes, std::size_t first) {
  return hn::Load(d_, lanes + first);
}

HWY_INLINE V set(float x) {
  return hn::Set(d_, x);
}

HWY_INLINE V square(V x) {
  return hn::Mul(x, x);
}

HWY_INLINE V dot(const SurfaceNode::Lanes (&a)[3], const float (&b)[3], std::size_t first) {
  const V x = hn::Mul(load(a[0], first), set(b[0]));
  const V y = hn::Mul(load(a[1], first), set(b[1]));
  const V z = hn::Mul(load(a[2], first), set(b[2]));
  return hn::Add(hn::Add(x, y), z);
}

template <class M> HWY_INLINE std::uint32_t bits(M mask, std::size_t first) {
  std::uint8_t byte[8] = {};
  hn::StoreMaskBits(d_, mask, byte);
  return static_cast<std::uint32_t>(byte[0]) << first;
}

struct Range {
  V low, high;
};

// Between which values the linear function slope . x is on the children, by their boxes alone.
HWY_INLINE Range box_range(const SurfaceNode& node, const float (&slope)[3], std::size_t first) {
  const V at = dot(node.center, slope, first);
  const float size[3] = {slope[0] < 0 ? -slope[0] : slope[0], slope[1] < 0 ? -slope[1] : slope[1],
                         slope[2] < 0 ? -slope[2] : slope[2]};
  const V box = dot(node.half, size, first);
  return {hn::Sub(at, box), hn::Add(at, box)};
}

// The same by their plates, too.
HWY_INLINE Range range(const SurfaceNode& node, const float (&slope)[3], float length,
                       std::size_t first) {
  const Range box = box_range(node, slope, first);
  const V at = dot(node.center, slope, first);
  const V along = dot(node.normal, slope, first);
  constexpr float error = 1e-6F; // of a squared cosine
  const V across =
      hn::Sqrt(hn::Max(hn::Sub(set((1 + error) * length * length), square(along)), set(0)));
  const V plate = hn::Add(hn::Mul(load(node.thickness, first), hn::Abs(along)),
                          hn::Mul(load(node.radius, first), across));
  const V plate_at = hn::Add(at, hn::Mul(load(node.middle, first), along));
  return {hn::Max(box.low, hn::Sub(plate_at, plate)), hn::Min(box.high, hn::Add(plate_at, plate))};
}

// The last of the least lanes, if that is below `most`; else -1.
HWY_INLINE int last_least(const SurfaceNode::Lanes& lanes, float most) {
  V least = load(lanes, 0);
  for (std::size_t i = hn::Lanes(d_); i < SurfaceNode::width; i += hn::Lanes(d_)) {
    least = hn::Min(least, load(lanes, i));
  }
  least = hn::MinOfLanes(d_, least);
  std::uint32_t set = 0;
  for (std::size_t i = 0; i < SurfaceNode::width; i += hn::Lanes(d_)) {
    set |= bits(hn::Eq(load(lanes, i), least), i);
  }
  return hn::GetLane(least) < most ? std::bit_width(set) - 1 : -1;
}

int least_lane(const SurfaceNode::Lanes& lanes, float most) {
  return last_least(lanes, most);
}

int near(const SurfaceNode& node, const float (&p)[3], float most, SurfaceNode::Lanes& squared) {
  for (std::size_t i = 0; i < SurfaceNode::width; i += hn::Lanes(d_)) {
    V box = set(0);
    V all = set(0);
    V height = set(0);
    for (int k = 0; k < 3; ++k) {
      const V d = hn::Sub(set(p[k]), load(node.center[k], i));
      box = hn::Add(box, square(hn::Max(hn::Sub(hn::Abs(d), load(node.half[k], i)), set(0))));
      all = hn::Add(all, square(d));
      height = hn::Add(height, hn::Mul(load(node.normal[k], i), d));
    }
    constexpr float error = 1e-6F;
    const V aside =
        hn::Sqrt(hn::Max(hn::Sub(hn::Mul(set(1 - error), all), square(height)), set(0)));
    const V above =
        hn::Sub(hn::Abs(hn::Sub(height, load(node.middle, i))), load(node.thickness, i));
    const V plate = hn::Add(square(hn::Max(above, set(0))),
                            square(hn::Max(hn::Sub(aside, load(node.radius, i)), set(0))));
    hn::Store(hn::Max(box, plate), d_, squared + i);
  }
  return last_least(squared, most);
}

std::uint32_t within(const SurfaceNode& node, const SlabQuery& query, float reach) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < SurfaceNode::width; i += hn::Lanes(d_)) {
    V squared = set(0);
    for (int k = 0; k < 3; ++k) {
      const V d = hn::Abs(hn::Sub(load(node.center[k], i), set(query.center[k])));
      const V gap = hn::Sub(hn::Sub(d, load(node.half[k], i)), set(query.half[k] + frame_rounding));
      squared = hn::Add(squared, square(hn::Max(gap, set(0))));
    }
    auto meets =
        hn::And(hn::Le(squared, set(reach * reach)), hn::Ge(load(node.half[0], i), set(0)));
    for (int s = 0; s < query.count; ++s) {
      const SlabQuery::Slab& slab = query.slab[s];
      const Range r = s == 0 ? range(node, slab.normal, 1, i) : box_range(node, slab.normal, i);
      meets = hn::And(meets, hn::And(hn::Le(hn::Sub(r.low, set(reach)), set(slab.high)),
                                     hn::Ge(hn::Add(r.high, set(reach)), set(slab.low))));
    }
    result |= bits(meets, i);
  }
  return result;
}

std::uint32_t above(const SurfaceNode& node, const PrismQuery& query, float lower,
                    SurfaceNode::Lanes& height) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < SurfaceNode::width; i += hn::Lanes(d_)) {
    const Range top = range(node, query.plane[0].normal, 1, i);
    const V high = hn::Sub(top.high, set(query.plane[0].offset));
    hn::StoreU(high, d_, height + i);
    auto meets = hn::And(hn::Gt(high, set(lower)), hn::Ge(load(node.half[0], i), set(0)));
    meets = hn::And(meets, hn::Le(hn::Sub(top.low, set(query.plane[0].offset)), set(query.upper)));
    for (int s = 1; s < 4; ++s) {
      const Range r = box_range(node, query.plane[s].normal, i);
      meets =
          hn::And(meets, hn::Le(hn::Sub(r.low, set(query.plane[s].offset)), set(frame_rounding)));
    }
    result |= bits(meets, i);
  }
  return result;
}

std::uint32_t in_column(const SurfaceNode& node, const ColumnQuery& query, ColumnRanges& ranges) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < SurfaceNode::width; i += hn::Lanes(d_)) {
    const auto bounds = [&](int a) HWY_ATTR {
      const ColumnQuery::Linear& f = query.function[a];
      const Range r = a == 0 ? range(node, f.slope, f.length, i) : box_range(node, f.slope, i);
      return Range{hn::Add(r.low, set(f.offset - f.slack)),
                   hn::Add(r.high, set(f.offset + f.slack))};
    };
    const Range height = bounds(0);
    const Range b = bounds(1);
    const Range c = bounds(2);
    const Range rest = bounds(3);
    hn::StoreU(height.high, d_, ranges.height + i);
    hn::StoreU(b.low, d_, ranges.low_b + i);
    hn::StoreU(b.high, d_, ranges.high_b + i);
    hn::StoreU(c.low, d_, ranges.low_c + i);
    hn::StoreU(c.high, d_, ranges.high_c + i);
    auto meets =
        hn::And(hn::Gt(height.high, set(query.lowest)), hn::Lt(height.low, set(query.highest)));
    meets = hn::And(meets, hn::And(hn::Ge(b.high, set(0)), hn::Ge(c.high, set(0))));
    meets =
        hn::And(meets, hn::And(hn::Ge(rest.high, set(0)), hn::Ge(load(node.half[0], i), set(0))));
    result |= bits(meets, i);
  }
  return result;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(least_lane);
HWY_EXPORT(near);
HWY_EXPORT(within);
HWY_EXPORT(above);
HWY_EXPORT(in_column);

int least_below(const SurfaceNode::Lanes& lanes, float most) {
  return HWY_DYNAMIC_DISPATCH(least_lane)(lanes, most);
}

int nearest_child(const SurfaceNode& node, const float (&p)[3], float most,
                  SurfaceNode::Lanes& squared) {
  return HWY_DYNAMIC_DISPATCH(near)(node, p, most, squared);
}

std::uint32_t children_within(const SurfaceNode& node, const SlabQuery& query, float reach) {
  return HWY_DYNAMIC_DISPATCH(within)(node, query, reach);
}

std::uint32_t children_above(const SurfaceNode& node, const PrismQuery& query, float lower,
                             SurfaceNode::Lanes& height) {
  return HWY_DYNAMIC_DISPATCH(above)(node, query, lower, height);
}

std::uint32_t children_in_column(const SurfaceNode& node, const ColumnQuery& query,
                                 ColumnRanges& ranges) {
  return HWY_DYNAMIC_DISPATCH(in_column)(node, query, ranges);
}

} // namespace cagewright
#endif
