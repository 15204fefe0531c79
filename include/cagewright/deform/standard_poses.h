/// \file
/// Two deformations defined for every model, to compare how well cages carry them.
#pragma once

#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace cagewright {

enum class StandardPose { bend, twist };
constexpr std::array<StandardPose, 2> standard_poses = {StandardPose::bend, StandardPose::twist};

std::string_view name_of(StandardPose pose);

/// Where a model's standard poses take place: its axis-aligned box.
///
/// The spine is the segment through the center of the box along its longest axis; of axes equally
/// long the first of x, y, z. With L its length, s the distance of a point from the center along it
/// and t = clamp(s / L, -1/2, 1/2):
///  - bend: the spine becomes a circular arc of the same length that turns by 90 degrees from end
///  to
///    end, in the plane of the longest and the shortest axis (of equally short ones the last),
///    towards the positive side of the shortest. The center and the directions there stay, each end
///    turns by 45 degrees; every point keeps its place in the frame that travels along the spine.
///    Beyond the ends the spine goes straight on. The radius is 2 L / pi, so that no point of the
///    box comes as far as the center of the circle: the deformation is one to one.
///  - twist: every point is turned about the spine by 90 degrees times t: by -45 at one end, 0 in
///    the middle, 45 at the other.
struct PoseFrame {
  Vec3 center = Vec3::Zero();
  Vec3 along = Vec3::UnitX();  ///< of the spine
  Vec3 toward = Vec3::UnitY(); ///< the side to which it bends
  double length = 1;           ///< of the spine
};

/// The frame of the box of V points, V > 0.
PoseFrame pose_frame(std::span<const Vec3> positions);

/// Where a pose takes a point.
Vec3 posed(StandardPose pose, const PoseFrame& frame, const Vec3& p);

/// How far a model that follows its cage is from the model deformed directly, over its vertices, in
/// diagonals of its box.
struct PoseError {
  double mean = 0;
  double max = 0;
};

struct PoseErrors {
  std::array<PoseError, standard_poses.size()> of = {}; ///< by StandardPose
  std::size_t undefined = 0; ///< vertices without weights: they stay at rest, and count as they are
  std::size_t outside =
      0; ///< of vertices outside the cage, where the kind is not defined; as these
  std::array<std::vector<Vec3>, standard_poses.size()> followed; ///< where the V vertices go
};

/// Takes the vertices of the cage alone through each pose, lets the model follow, and compares its
/// V vertices with the pose of the model itself.
///
/// \param coordinates  of the cage; it may be open or invalid where the kind makes sense of it
/// \param model        V positions, V > 0
/// Errors: invalid_cage (as the kind says), cancelled.
/// Cost: that of binding, O(V F); no memory for weights. The same on any number of threads.
Result<PoseErrors> pose_errors(const Coordinates& coordinates, std::span<const Vec3> model,
                               const Progress& progress = {});

/// The same, with the coordinates that the settings name.
Result<PoseErrors> pose_errors(const PolygonMesh& cage, std::span<const Vec3> model,
                               CoordinateSettings settings = {}, const Progress& progress = {});

} // namespace cagewright
