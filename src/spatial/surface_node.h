/// \file
/// The nodes of a SurfaceTree, and what is asked of all children of one at once.
#pragma once

#include <cagewright/mesh/triangle_mesh.h>

#include <cstdint>

namespace cagewright {

/// Eight boxes in the tree's own frame, in single precision, large enough to make up for it, and
/// in each of them a plate: where the surface is nearly flat it is far thinner than the box. So
/// the cost of a query depends on how the surface bends, not on how finely it is cut. Empty slots
/// have boxes that nothing meets.
struct alignas(32) SurfaceNode {
  static constexpr int width = 8;
  using Lanes = float[width];

  Lanes center[3];
  Lanes half[3];
  Lanes normal[3];    ///< of the plate
  Lanes middle;       ///< its height above the center of the box, along the normal
  Lanes thickness;    ///< half of it
  Lanes radius;       ///< round the line through the center along the normal
  Index child[width]; ///< a node, or a triangle with the leaf bit
};

/// Rounding of a few operations on coordinates up to about four, in single precision. All tests of
/// boxes err by so much towards visiting them.
inline constexpr float frame_rounding = 4e-6F;

// Queries of a node. Vectors and lengths are in the frame. The numbers are the same with every
// instruction set.

/// The lane with the least number, the last of several, if that number is below `most`; else -1.
int least_below(const SurfaceNode::Lanes& lanes, float most);

/// Lower bounds of the squared distances of all children to p, and `least_below` of them.
int nearest_child(const SurfaceNode& node, const float (&p)[3], float most,
                  SurfaceNode::Lanes& squared);

// The others return a set of children as bits, and write numbers about all of them.

/// A triangle: its box, and slabs that contain it. Of the first slab's normal the plates are
/// heeded.
struct SlabQuery {
  struct Slab {
    float normal[3]; ///< length one
    float low, high;
  };
  float center[3];
  float half[3];
  Slab slab[4];
  int count = 0;
};
/// Those that may be as near as `reach`.
std::uint32_t children_within(const SurfaceNode& node, const SlabQuery& query, float reach);

/// A plane and three half spaces, normal . x <= offset.
struct PrismQuery {
  struct Plane {
    float normal[3]; ///< length one
    float offset;
  };
  Plane plane[4]; ///< heights are above the first
  float upper;    ///< what lies wholly above this is left out
};
/// Those that may be inside with something above `lower`, and upper bounds of the heights.
std::uint32_t children_above(const SurfaceNode& node, const PrismQuery& query, float lower,
                             SurfaceNode::Lanes& height);

/// A linear function for heights, and three that are at least 0 in the column.
struct ColumnQuery {
  struct Linear {
    float slope[3];
    float length; ///< of the slope
    float offset;
    float slack; ///< of rounding
  };
  Linear function[4];
  float lowest, highest;
};
struct ColumnRanges { ///< of the second and the third function
  SurfaceNode::Lanes height, low_b, high_b, low_c, high_c;
};
/// Those that may be in the column between the heights.
std::uint32_t children_in_column(const SurfaceNode& node, const ColumnQuery& query,
                                 ColumnRanges& ranges);

} // namespace cagewright
