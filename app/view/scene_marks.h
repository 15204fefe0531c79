/// \file
/// What the viewport draws of a document besides the model, as lines, dots and faces.
#pragma once

#include "app/document/document.h"
#include "app/edit/cage_graph.h"
#include "app/edit/gizmo.h"
#include "app/edit/orbit_camera.h"
#include "app/edit/pick.h"
#include "app/view/canvas.h"

#include <optional>
#include <vector>

namespace cagewright::app {

/// The colours of the viewport.
struct ViewColors {
  Rgb top, bottom, model, wire, cage, cage_face, selected, hovered, bad, grid, text;
  static ViewColors light();
  static ViewColors dark();
};

/// A colour for a weight: blue below 0, grey at 0, to yellow at 1.
Color weight_color(float weight);
Rgb weight_rgb(float weight);
/// Weights from here to 1 have colours of their own; the scale goes through grey at 0.
constexpr float least_weight = -0.5F;
/// A color for a painted density: red where the cage is to be finer, blue where coarser, as in
/// files; the model's own where neither.
Color density_color(float density, const Rgb& model);
/// And for the share of another kind of coordinates, from none, the model's own color, to all.
Rgb share_rgb(float share, const Rgb& model);
Color share_color(float share, const Rgb& model);
/// A colour for a distance, a fraction of the diagonal: the same scale, full at 0.08.
Color distance_color(float distance);

/// The cage as it is shown: edges, faces, vertices, with what is selected, wrong, or under the
/// cursor.
void add_cage(const Document& document, const PolygonMesh& cage, const CageGraph& graph,
              const OrbitCamera& camera, const ViewColors& colors,
              const std::optional<Pick>& hovered, Marks& marks);

/// Where the cage is at rest.
void add_rest(const Document& document, const CageGraph& graph, const ViewColors& colors,
              Marks& marks);

/// Boxes and cuts of the stages.
void add_boxes(const Document& document, Marks& marks);

/// The sides of voxels that no other shown voxel covers. Slow; keep the result.
std::vector<FaceMark> voxel_faces(const BoxDecomposition& stages, bool feature, bool inner);

void add_problems(const Document& document, const ViewColors& colors, Marks& marks);

void add_grid(const Box3& bounds, const OrbitCamera& camera, const ViewColors& colors,
              Marks& marks);

/// The gizmo on the screen.
void add_gizmo(const OrbitCamera& camera, TransformKind kind, const GizmoFrame& frame,
               Handle hovered, Overlay& overlay);

/// The axes of the world, in the corner.
void add_tripod(const OrbitCamera& camera, Overlay& overlay);
/// Where the letters of the tripod go.
std::array<Pixel, 3> tripod_tips(const OrbitCamera& camera);

Rgb axis_color(int axis);

} // namespace cagewright::app
