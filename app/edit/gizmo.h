/// \file
/// The handles of the transform gizmo: where they are, and which one is under the cursor.
#pragma once

#include "app/edit/orbit_camera.h"
#include "app/edit/transform.h"

#include <vector>

namespace cagewright::app {

enum class Handle {
  none,
  x,
  y,
  z,
  yz, ///< the plane of two axes, named like the others by what moves
  zx,
  xy,
  view,      ///< across the line of sight; for scaling, all axes alike
  trackball, ///< turns freely
};

/// Where a gizmo stands.
struct GizmoFrame {
  Vec3 origin = Vec3::Zero();
  Mat3 axes = Mat3::Identity(); ///< columns, orthonormal
};

/// A handle's shape in space: to be drawn, and to be hit.
struct GizmoShape {
  Handle handle = Handle::none;
  std::vector<Vec3> points; ///< a line, or the outline of an area
  bool filled = false;
  bool grabs = true; ///< false: drawn only
};

/// The shapes of a gizmo, from the one behind to the one in front, as large on the screen wherever
/// it stands. Axes that point at the viewer and planes seen from their edge are left out: one could
/// not drag them. None when the origin is behind the eye.
std::vector<GizmoShape> gizmo_shapes(const OrbitCamera& camera, TransformKind kind,
                                     const GizmoFrame& frame);

/// The handle within a few pixels of the cursor; of several the nearest.
Handle handle_at(const OrbitCamera& camera, TransformKind kind, const GizmoFrame& frame,
                 const Pixel& cursor);

/// The index of an axis handle, or of the axis that a plane's handle leaves out; -1 for others.
int axis_of(Handle handle);
bool is_plane(Handle handle);

} // namespace cagewright::app
