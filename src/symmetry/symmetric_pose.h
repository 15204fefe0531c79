/// \file
/// A surface brought from the pose that it is in to one that is its own mirror image.
#pragma once

#include "spatial/bvh.h"
#include "symmetry/half.h"
#include "symmetry/posed_reflection.h"
#include "symmetry/rigid_net.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <vector>

namespace cagewright {

/// Where the vertices go: midway between the surface and its mirror image under the map, so that
/// each of two arms bends half as far as they differ. Edges are bent as little as that takes
/// (rigid_net.h).
///
/// \returns V positions in the frame: nearly their own mirror images in x = 0, as the map is
/// Cost: two sparse factorisations, and some 80 solutions.
std::vector<Vec3> symmetric_pose(const TriangleMesh& surface, const PosedReflection& map,
                                 const MirrorFrame& frame, const Progress& progress = {});

/// Takes points along from one pose of a surface to another, each as the nearest point of the
/// surface is moved and turned.
class PoseChange {
public:
  PoseChange(TriangleMesh from, std::vector<Vec3> to);

  [[nodiscard]] Vec3 operator()(const Vec3& p) const;
  [[nodiscard]] TriangleMesh operator()(TriangleView mesh) const;

private:
  TriangleMesh from_;
  std::vector<Vec3> to_;
  std::vector<Mat3> turns_;
  TriangleBvh tree_;
};

} // namespace cagewright
