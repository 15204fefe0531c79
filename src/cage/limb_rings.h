/// \file
/// Where limbs begin: rings of edges round them. Internal to this module.
#pragma once

#include "improve/seam_band.h"
#include "obb/oriented_box.h"
#include <cagewright/cage/generate_options.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <span>
#include <vector>

namespace cagewright {

/// A plane that a part of the model is cut by.
struct LimbCut {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();
  OrientedBox box; ///< of the part
};

/// The cuts of the box tree of a model, in the model's coordinates, the first cut first. A part is
/// cut where the boxes of its halves get smallest: where a limb begins, and where it bends. None if
/// the model cannot be cut, or when it was cancelled.
std::vector<LimbCut> limb_cuts(TriangleView model, const Progress& progress = {});

struct LimbRings {
  /// Of each face of the cage the part it belongs to: 0 is what is left of the body. The edges
  /// between two parts are loops without common vertices; of half a cage also chains from boundary
  /// to boundary.
  std::vector<Index> parts;
  std::vector<SeamBand> bands; ///< by part: where its ring stays
  int count = 0;               ///< of rings, in the whole cage
};

/// Chooses rings on a fine cage: closed loops of its edges, in planes across the directions that
/// the model was cut in. With V the volume of the limb beyond a ring and A the area within, a limb
/// begins where V / A^1.5 is greatest: further in the ring gets wider, further out the limb is
/// shorter; and askew it would be wider too. If the budget has room for more, rings follow along
/// the cuts themselves, where limbs bend.
///
/// Every ring has a limb on one side that is about as long as the ring is wide, or longer, and much
/// more on the other. There is room between rings. Limbs that are too small a part of the surface
/// for their share of the vertices get none.
///
/// \param start     closed, or the half of a symmetric cage, whose border lies in the mirror plane;
///                  in the coordinates of the cuts
/// \param vertices  of the cage to be made; a fifth of them may be on rings
/// Cost: O(planes * faces), some hundred planes.
/// \param joints  where rings are wanted first of all: two fifths of the vertices may be on rings
///                then. Of the rings in planes through a joint that which bounds the smallest area
///                is taken, in planes across its direction as far as that is known
LimbRings limb_rings(TriangleView start, std::span<const LimbCut> cuts, int vertices,
                     std::span<const LimbJoint> joints = {});

/// The rings on the start for the limbs of the model; none, without a search, if there are too few
/// vertices for one, or none is asked for (0).
LimbRings find_limb_rings(TriangleView start, TriangleView model, int vertices,
                          std::span<const LimbJoint> joints = {}, const Progress& progress = {});

/// The rings at joints alone: none about which no ring goes.
LimbRings rings_at_joints(TriangleView start, std::span<const LimbJoint> joints, int vertices);

/// A limb, as it hangs on the rest of the model.
struct Limb {
  LimbJoint joint;          ///< where it bends; `along` has length one
  double width = 0;         ///< of the limb there: the diameter of a circle of its cross-section
  std::vector<Index> faces; ///< of the surface, beyond the joint
};

/// The limbs of a closed surface that limb_rings() would put rings on, largest first; those at the
/// joints where some are given.
std::vector<Limb> find_limbs(TriangleView surface, std::span<const LimbCut> cuts, int vertices,
                             std::span<const LimbJoint> joints = {});

/// The closed loops of edges between the parts that the faces of a whole cage belong to.
std::vector<std::vector<Index>> rings_between(const PolygonMesh& cage,
                                              std::span<const Index> parts);

} // namespace cagewright
