/// \file
/// Meshes that move, to files: animated GLB, and the point caches PC2 and MDD.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <span>
#include <vector>

namespace cagewright {

/// A mesh that is at each frame the sum of so much of each of some shapes.
///
/// That is what a model bound to a cage does between keyframes: both the cage's curve in time and
/// the model's answer to the cage are linear.
struct MovingMesh {
  PolygonMesh rest;                        ///< V vertices
  MeshAttributes attributes;               ///< of it: texture points and materials go to GLB
  std::vector<Vec3> rest_normals;          ///< V, unit; or none: GLB gets none
  std::vector<std::vector<Vec3>> shapes;   ///< K times V positions
  std::vector<std::vector<Vec3>> normals;  ///< K times V, unit; or none
  std::vector<std::vector<double>> shares; ///< F frames of K numbers, each frame's with the sum 1
  double first_frame = 1;                  ///< the number of the first of them
  double frames_per_second = 24;

  /// V positions at a frame < F.
  [[nodiscard]] std::vector<Vec3> at(std::size_t frame) const;
};

/// Writes the movement as the extension says:
///  - .glb: glTF 2.0 with a morph target for each shape, and an animation of their weights; faces
///    are cut into triangles. Each frame is met to float precision, reckoned from the middle of the
///    mesh; between frames it moves evenly.
///  - .pc2, .mdd: point caches, see PointCacheWriter.
///
/// The file appears under its name only when complete. Errors: unsupported (another extension, or
/// more than a format can count), mismatch (other numbers of positions), cannot_write (also for a
/// position that is not finite), cancelled.
/// Cost: O(K V F) time for the caches, O(K V) for GLB.
Status write_animation(const MovingMesh& mesh, const std::filesystem::path& path,
                       const Progress& progress = {});

} // namespace cagewright
