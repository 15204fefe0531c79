/// \file
/// How the tools of the viewport behave: shown and changed by the tool bar, read by the tools.
#pragma once

namespace cagewright::app {

enum class Tool {
  select_box,
  select_lasso,
  translate,
  rotate,
  scale,
  pull,   ///< drags the model; the cage follows
  paint,  ///< where the cage is to be finer
  region, ///< what of the model the cage is for
  mix,    ///< where the model follows by another kind of coordinates
};

/// Whether a tool has a brush that goes over the model.
constexpr bool is_brush(Tool tool) {
  return tool == Tool::paint || tool == Tool::region || tool == Tool::mix;
}
enum class AxesKind { world, local, view };
enum class Falloff { smooth, linear, sharp };

/// Where the pivot of rotations and scalings lies.
enum class Pivot {
  median,       ///< the mean of the selected vertices
  bounding_box, ///< the middle of their axis-aligned box
  individual,   ///< each connected part of the selection has its own median
};

struct ToolSettings {
  Tool tool = Tool::translate; ///< clicking selects with every tool
  AxesKind axes = AxesKind::world;
  Pivot pivot = Pivot::median;
  bool see_through = false; ///< select what the cage's own faces hide, too
  bool snap = false;
  double snap_step = 0.01;          ///< of translations, a fraction of the model's diagonal
  double snap_angle_degrees = 15;   ///< of rotations
  double snap_scale = 0.1;          ///< of scalings
  bool proportional = false;        ///< neighbors follow, less with distance
  double proportional_radius = 0.1; ///< a fraction of the model's diagonal
  Falloff falloff = Falloff::smooth;
  bool connected_only = false;  ///< distances along the cage's edges, not through the air
  bool symmetric = false;       ///< the mirror image follows
  int symmetry_axis = 0;        ///< normal of the mirror plane: 0 x, 1 y, 2 z
  double brush_radius = 40;     ///< of painting, logical pixels
  double brush_strength = 0.25; ///< how much a stroke adds where it passes
  bool stop_at_contact = false; ///< refining: a drag goes no further than the cage stays valid
  friend bool operator==(const ToolSettings&, const ToolSettings&) = default;
};

} // namespace cagewright::app
