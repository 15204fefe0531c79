/// \file
/// What the viewport shows.
#pragma once

#include "app/edit/surface_look.h"

namespace cagewright::app {

struct Layers {
  bool model = true;
  bool smooth_normals = true; ///< else each face is flat
  bool wireframe = false;     ///< the model's edges
  SurfaceLook look = SurfaceLook::studio;
  bool occlusion = true; ///< shade in corners, while nothing moves
  bool cage_edges = true;
  bool cage_faces = true;
  bool cage_vertices = true;
  bool rest_cage = false;      ///< deforming: the cage at rest, faint
  bool boxes = false;          ///< the boxes of Document::stages() at `depth`
  bool feature_voxels = false; ///< voxels on the surface
  bool inner_voxels = false;
  bool cuts = false;     ///< the cutting planes of the boxes at `depth`
  bool problems = true;  ///< what the check found, where it is
  bool weights = false;  ///< colour map on the model: how much each vertex follows the selection
  bool distance = false; ///< colour map on the cage: how far it is from the model
  bool grid = true;      ///< the ground
  int depth = -1;        ///< of boxes and cuts; negative: the leaves
  int selected_box = -1; ///< a node of the tree, highlighted; -1: none
  friend bool operator==(const Layers&, const Layers&) = default;
};

} // namespace cagewright::app
