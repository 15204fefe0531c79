/// \file
/// How good a cage is, in numbers.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/validate/model_volume.h>

#include <cstddef>
#include <optional>

namespace cagewright {

/// Figures of a cage of C vertices and F triangles. Distances are fractions of the diagonal of the
/// model's bounding box, so that they do not depend on the unit; volumes are in the cube of the
/// coordinates' unit.
struct CageMetrics {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  double volume = 0; ///< signed: of a closed cage oriented outward, positive
  double model_volume = 0;
  VolumeMethod model_volume_method = VolumeMethod::none;
  double volume_ratio = 0;  ///< volume / model_volume; 0 when the model has no volume
  double clearance = 0;     ///< least distance between the two surfaces; 0 where they cross
  double mean_distance = 0; ///< from points of the cage to the model's nearest
  double max_distance = 0;  ///< the same, the greatest; the cage's vertices are among the points
  /// Of the free space between parts of the model that are near each other and far apart along its
  /// surface, the share inside the cage: see SpaceBetween. 0: nothing is joined, or there is none.
  double webbing = 0;
  double min_quality = 0;      ///< least 2 r / R of a cage triangle: 1 equilateral, 0 degenerate
  double low_quality = 0;      ///< 5th percentile of the same
  std::size_t max_valence = 0; ///< most faces at one vertex
  double min_dihedral = 0;     ///< least angle between neighbors, in degrees: 180 flat, 0 folded
};

/// Measures a cage against its model.
///
/// The mean distance is over some 20,000 points spread evenly over the cage, always the same.
///
/// \param cage          C vertices, F triangles; it need not be valid
/// \param model         V vertices, T triangles; without triangles all distances are 0
/// \param model_volume  if it is known, to save its computation
/// \returns what was measured before it was to stop, if it was
/// Cost: O((T + F) log(T + F)) time; parallel, the same on any number of threads.
CageMetrics measure_cage(TriangleView cage, TriangleView model,
                         const std::optional<ModelVolume>& model_volume = {},
                         const Progress& progress = {});

/// The same of polygons: of the triangles that to_triangle_mesh() cuts them into, but the valence
/// is that of the polygons.
CageMetrics measure_cage(const PolygonMesh& cage, TriangleView model,
                         const std::optional<ModelVolume>& model_volume = {},
                         const Progress& progress = {});

} // namespace cagewright
