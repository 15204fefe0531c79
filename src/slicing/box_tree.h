/// \file
/// A shape cut again and again: the tree of oriented boxes around its parts.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/cross_section.h"
#include "slicing/partition.h"
#include "slicing/published_rule.h"
#include "voxel/voxel_grid.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/slicing/slicing_rule.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace cagewright {

struct SlicingOptions {
  SlicingRule rule = SlicingRule::volume;
  int depth = 5;     ///< how often a part may be cut: depth 0 is one box; 0 to 20
  int max_boxes = 0; ///< stop at this many boxes, cutting first where it pays most; 0: no limit
  bool split_parts = true; ///< the connected parts of a half get a box each; false: strictly binary
  double eta = 1.1;        ///< T1: stop when min f / max f is above, and T2 too; above 1: never
  double zeta = 1.1;       ///< T2: stop when shortest / longest edge is above, and T1 too
  double min_jump = 0.15;  ///< published rule: least clear jump, as a fraction of the greatest f
  NoJump no_jump = NoJump::middle; ///< published rule: what to do when no jump is clear
  double min_gain = 0.015; ///< volume rule: a cut must save this fraction of the box's volume
  double padding = 0.25;   ///< of a voxel, by which boxes reach beyond their voxels
  CrossSectionOptions cross_section = {};
};

/// Why a box was not cut.
enum class StopReason {
  cut,       ///< it was
  depth,     ///< it lies as deep as was asked for
  too_small, ///< no cut leaves a part worth a box on either side
  prismatic, ///< T1 > eta and T2 > zeta
  no_jump,   ///< published rule with NoJump::skip: no clear jump on any axis
  no_gain,   ///< volume rule: no cut saves enough volume
  max_boxes, ///< the limit on the number of boxes was reached
};

std::string_view name_of(StopReason reason);
std::string_view name_of(SlicingRule rule);

/// The cut that made the children of a box.
struct Cut {
  CutPlane plane;
  Vec3 point;          ///< where the plane meets the axis, in the units of the grid
  Vec3 normal;         ///< unit normal: the axis
  double jump = 0;     ///< published rule: height of the jump, a fraction of the greatest f
  double gain = 0;     ///< volume saved by the children's boxes, a fraction of the box's
  bool middle = false; ///< published rule: no jump was clear
};

struct BoxNode {
  int parent = -1; ///< index of the node; -1 for the root
  int depth = 0;
  OrientedBox box;                      ///< contains all corners of the voxels; axes longest first
  std::vector<std::uint32_t> voxels;    ///< indices into the grid, ascending
  std::array<CrossSection, 3> sections; ///< f along the axes of the box
  double prismatic_ratio = 1;           ///< T1
  double cube_ratio = 1;                ///< T2
  std::optional<Cut> cut;
  std::vector<int> children; ///< indices of nodes; empty for a leaf
  StopReason stop = StopReason::depth;
};

/// Nodes in the order in which they were made: the root first, children after their parent.
struct BoxTree {
  std::vector<BoxNode> nodes;

  /// The nodes that cover the shape after `depth` cuts: those at that depth, and leaves above it.
  /// A negative depth gives the leaves.
  [[nodiscard]] std::vector<int> cover(int depth = -1) const;
};

/// Builds the tree over the occupied voxels (inner and feature).
///
/// Each child's box contains all corners of its voxels, so the union of the boxes of any cover
/// contains every occupied voxel, and the model with them, by construction.
///
/// Errors: unfit_model when no voxel is occupied, invalid_option, cancelled.
/// Cost: O(N log N) for N occupied voxels, for each level; boxes of a level are cut in parallel.
Result<BoxTree> build_box_tree(const VoxelGrid& grid, const SlicingOptions& options = {},
                               const Progress& progress = {});

} // namespace cagewright
