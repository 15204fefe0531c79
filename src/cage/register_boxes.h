/// \file
/// Neighbouring boxes joined face to face, so that they share a quad instead of overlapping.
#pragma once

#include "cage/hexahedron.h"
#include "obb/oriented_box.h"
#include "voxel/voxel_grid.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace cagewright {

/// A box and the voxels it was made for: it contains all their corners.
struct BoxContents {
  OrientedBox box;
  std::span<const std::uint32_t> voxels; ///< indices into the grid; no voxel is in two boxes
};

struct RegisterOptions {
  double min_facing_angle = 120; ///< degrees between the outward normals of two faces that may join
  double min_area_ratio = 0.6;   ///< of the smaller to the larger of the two faces
  double min_size_ratio = 0.1;   ///< of the smaller to the larger box, by volume
  double max_distance =
      0.75;                 ///< between the centers of the faces, over the root of their mean area
  double clearance = 0.1;   ///< kept round the voxels, in voxels
  double max_growth = 0.15; ///< of the volume of the two solids, a fraction
  double min_angle = 40;    ///< degrees, at the corners of the quads and between faces
  double max_bend = 25;     ///< degrees between the two triangles of a quad
};

/// Face `face0` of solid `solid0` is face `face1` of solid `solid1`.
struct Joint {
  std::uint32_t solid0 = 0;
  int face0 = 0;
  std::uint32_t solid1 = 0;
  int face1 = 0;
};

/// What became of a pair of faces that were alike and near enough.
enum class JointVerdict {
  joined,
  taken,       ///< one of the boxes is already joined at that face or at one beside it
  misshapen,   ///< a solid would not be convex, or too bent, or too sharp
  too_large,   ///< the solids would need too much more volume
  uncontained, ///< a voxel would be cut off
  runs_into,   ///< a solid would run into a box that holds another part of the model
};
inline constexpr int joint_verdicts = 6;

std::string_view name_of(JointVerdict verdict);

struct Registration {
  std::vector<Hexahedron> solids; ///< one for each box, in order; faces of joints are `shared`
  std::vector<Joint> joints;
  std::array<int, joint_verdicts> verdicts{}; ///< how many pairs of faces met which end
};

/// Joins boxes whose contents touch at pairs of faces that face each other, each pair at one
/// rectangle; both boxes become hexahedra that end there. The others stay boxes.
///
/// Xian, Lin and Gao, "Automatic cage generation by improved OBBs for mesh deformation", The Visual
/// Computer, 2012. The paper's plane is perpendicular to the line between the
/// centers of the faces, and its rectangle is that of the corners projected on the plane. Where
/// boxes meet at an angle or overlap this cuts off contents or tilts the plane, so the bisecting
/// plane, and the corners moved along the boxes' own edges (a mitre), are tried too. The least
/// volume wins, a plane near the bisecting one counting for a little.
///
/// A joint is made only if the union of the solids still contains every voxel with `clearance`
/// around it, what lies beyond the plane of a joint being the neighbour's. The best pairs are
/// joined first. A box has joints at no two adjacent faces.
///
/// \param boxes  B boxes over the voxels of `grid`
///
/// Errors: invalid_option (a voxel index that the grid does not have), cancelled.
/// Cost: O(B^2 + voxels), and for each pair of faces tried O(surface voxels of the two boxes).
Result<Registration> register_boxes(const VoxelGrid& grid, std::span<const BoxContents> boxes,
                                    const RegisterOptions& options = {},
                                    const Progress& progress = {});

/// The boxes as they are, joined nowhere.
Registration keep_apart(std::span<const BoxContents> boxes);

} // namespace cagewright
