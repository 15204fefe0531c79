/// \file
/// Which faces of the model lie within an outline on the screen.
#pragma once

#include "app/edit/orbit_camera.h"
#include "spatial/bvh.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <vector>

namespace cagewright::app {

/// An outline as it was drawn.
struct ScreenOutline {
  OrbitCamera camera;
  std::vector<Pixel> pixels;
  bool see_through = false; ///< take what other faces hide, too
};

/// Faces whose middle lies within the outline and of which something is seen; ascending.
/// \param bvh  over the mesh's triangles
/// Cost: O(F log F) on all cores. Errors: cancelled.
Result<std::vector<Index>> outlined_faces(const PolygonMesh& mesh, const TriangleBvh& bvh,
                                          const ScreenOutline& outline,
                                          const Progress& progress = {});

} // namespace cagewright::app
